// What views see of the texels of a level, and sums of coefficients there.
#pragma once

#include <vector>

#include "btf/bilinear_texels.h"
#include "compress/direction_bases.h"

namespace velour {

/// Clusters of each texel, distinct and ascending, and their coefficients.
struct TensorTexelValues {
  std::vector<uint32_t> member;  // [texel][k]
  RowMatrix value;               // [texel][k, rank]

  Index members() const { return static_cast<Index>(member.size()) / value.rows(); }
  Index rank() const { return value.cols() / members(); }
};

/// Where the views' rays through the centres of a level's texels meet its relief.
class SeenTexels {
 public:
  SeenTexels(const TensorSource& source, size_t level, const Progress& progress);

  const Relief& relief() const { return relief_; }
  bool plane() const { return plane_; }
  size_t texels() const { return size_t{relief_.width()} * relief_.height(); }
  /// Each is its own on the plane.
  BilinearTexels at(Index view, size_t texel) const;

  /// Texels of a view by those that they see, so that threads do not meet and sums have one order.
  struct Sources {
    std::vector<uint32_t> first;   // of each texel
    std::vector<uint32_t> source;  // texels of the view
    std::vector<float> weight;
  };
  Sources sources(Index view) const;

  /// Coefficients that texels first ... end - 1 of a view see: texel x function, of `functions` in all.
  RowMatrix spread(Index view, size_t first, size_t end, const TensorTexelValues& values, Index functions) const;

 private:
  const Relief& relief_;
  bool plane_;
  std::vector<Vec2> seen_;  // [view][texel]: in texels; none on the plane
};

}  // namespace velour

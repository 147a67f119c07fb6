// The texels of a level seen by views, and interpolation of coefficients there.
#pragma once

#include <vector>

#include "btf/fit/tensor/direction_bases.h"
#include "image/bilinear_texels.h"

namespace velour {

/// Clusters of each texel, distinct and ascending, and their coefficients.
struct TensorTexelValues {
  std::vector<uint32_t> member;  // [texel][k]
  RowMatrix value;               // [texel][k, rank]

  Index members() const { return static_cast<Index>(member.size()) / value.rows(); }
  Index rank() const { return value.cols() / members(); }
};

/// Points where the view rays through the centers of a level's texels hit its relief.
class SeenTexels {
 public:
  SeenTexels(const TensorSource& source, size_t level, const Progress& progress);

  const Relief& relief() const { return relief_; }
  bool plane() const { return plane_; }
  size_t texels() const { return size_t{relief_.width()} * relief_.height(); }
  /// The texel itself on the plane.
  BilinearTexels at(Index view, size_t texel) const;

  /// Texels of a view grouped by the texels they see, so that threads do not conflict and sums have a fixed order.
  struct Sources {
    std::vector<uint32_t> first;   // start of each texel's sources, and the end
    std::vector<uint32_t> source;  // texels of the view
    std::vector<float> weight;
  };
  Sources sources(Index view) const;

  /// Coefficients seen by texels [first, end) of a view: texel x function, with `functions` columns.
  RowMatrix spread(Index view, size_t first, size_t end, const TensorTexelValues& values, Index functions) const;

 private:
  const Relief& relief_;
  bool plane_;
  std::vector<Vec2> seen_;  // [view][texel], in texels; empty on the plane
};

}  // namespace velour

// Visibility of a level's texels in the views, and stand-ins for the views that hide them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>
#include "btf/fit/tensor/direction_bases.h"
#include "image/texels.h"

namespace velour {

/// For every direction, the indices of all directions, nearest first.
std::vector<std::vector<Index>> nearest_first(const std::vector<Vec3>& directions);

/// Visibility of the relief points at the centers of a level's texels. A point hidden from a view is assumed to look as
/// from the nearest view that shows it. Views between two captured ones are interpolated, and one of the two may hide a
/// point that is visible from between them: its value there must be plausible, although no image determines it.
class ShownViews {
 public:
  /// Weight of a hidden point in a fit, relative to a visible one.
  static constexpr float kHidden = 0.002f;

  /// Keeps a reference to `source`.
  ShownViews(const TensorSource& source, size_t level, const Progress& progress);

  size_t texels() const { return texels_; }
  Index views() const { return static_cast<Index>(source_.side.view.size()); }
  /// The view whose values are used: `view` itself if it shows the texel, -1 if no view does.
  Index stand_in(size_t texel, Index view) const {
    return stand_in_[texel * source_.side.view.size() + static_cast<size_t>(view)];
  }
  bool shown(size_t texel, Index view) const { return stand_in(texel, view) == view; }
  /// Whether every view shows every texel.
  bool all() const { return all_; }

  /// Values of the texels in a view, texel x light per axis; 0 where it hides them.
  using Values = std::array<RowMatrix, 3>;
  Values values(Index view, const LevelImages& images, const Progress& progress) const;

 private:
  const TensorSource& source_;
  const Relief& relief_;
  size_t texels_;
  bool all_ = true;
  std::vector<int32_t> stand_in_;  // [texel][view]
};

// The texels of a level seen by views, and interpolation of coefficients there.

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

// Which views show the texels of a level, and which ones stand in for those that do not.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "compress/direction_bases.h"

namespace velour {

/// Of every direction all of them, the nearest first.
std::vector<std::vector<Index>> nearest_first(const std::vector<Vec3>& directions);

/// Views of the points of a relief at the centres of a level's texels. A point that a view hides is taken to look there
/// as from the nearest view that shows it. Views between two captured ones are interpolated, and one of the two may
/// hide a point that is seen from between them: what it is there has to be within reason, though no image tells.
class ShownViews {
 public:
  /// What a hidden point weighs in a fit, against 1 of one that is shown.
  static constexpr float kHidden = 0.002f;

  /// Keeps a reference.
  ShownViews(const TensorSource& source, size_t level, const Progress& progress);

  size_t texels() const { return texels_; }
  Index views() const { return static_cast<Index>(source_.side.view.size()); }
  /// The view itself where it shows the texel; -1 where none does.
  Index stand_in(size_t texel, Index view) const {
    return stand_in_[texel * source_.side.view.size() + static_cast<size_t>(view)];
  }
  bool shown(size_t texel, Index view) const { return stand_in(texel, view) == view; }
  /// Whether every view shows every texel.
  bool all() const { return all_; }

  /// Of each axis texel x light: what a view shows of the texels, 0 where it hides them.
  using Values = std::array<RowMatrix, 3>;
  Values values(Index view, const LevelImages& images, const Progress& progress) const;

 private:
  const TensorSource& source_;
  const Relief& relief_;
  size_t texels_;
  bool all_ = true;
  std::vector<int32_t> stand_in_;  // [texel][view]
};

}  // namespace velour

// How narrow a lobe may be before it hides between the samples of a view.
#pragma once

#include <array>
#include <span>

#include "fit/slice_samples.h"
#include "srbf/warped_lobe.h"

namespace velour {

/// The solid angle that one sample of a view stands for, as it varies over the light directions: of the finest samples
/// about a direction, so that highlights, where samples crowd, may be sharp.
class SampleSpacing {
 public:
  /// `samples` weigh their solid angle (sr); `wv` is unit.
  SampleSpacing(std::span<const SliceSample> samples, const Vec3d& wv);

  /// The logarithm of the bandwidth of a lobe about `center` (unit, in the lobe's own space) that spreads over the
  /// solid angle of a sample there. Where there are no samples any bandwidth will do.
  double most_log_bandwidth(LobeSpace space, const Vec3d& center) const;

 private:
  static constexpr int kSide = 16;
  using Cells = std::array<float, static_cast<size_t>(kSide* kSide)>;
  static size_t cell_of(const Vec3d& wl);
  void spread(const Cells& finest);

  Vec3d wv_;
  Cells cell_;  // sr, over the equal-area disk of light directions
};

}  // namespace velour

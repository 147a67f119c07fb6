// Under which views and lights scenes show a material.
#pragma once

#include <array>
#include <cstdint>

#include "domain/surface_domain.h"
#include "sphere/view_range.h"

namespace velour {

/// Weights are what a hit contributes to the picture: the luminance of the path's throughput at it, in camera rays.
struct SceneDomain {
  static constexpr int kViewBins = 90;  // of theta_v, one degree each

  /// Weight of the hits, by the view's polar angle.
  std::array<double, kViewBins> view{};
  /// Camera rays behind the weights, hits or not; those of all frames together.
  uint64_t camera_rays = 0;
  uint64_t frames = 0;
  /// The most concentrated light seen, 1/sr: the density with which the renderer draws that direction of it, which is
  /// one over the solid angle of a lamp alone; infinite for a light without extent.
  double light_density = 0;
  /// Of each frame the SHA-256 of all that was observed; of several their sum, word by word, whatever their order.
  std::array<uint64_t, 4> hash{};
  /// Of a material that varies over the surface.
  SurfaceDomain surface;

  double weight() const;
  /// surface.views; where they are not known, as in files of earlier versions, what `view` says of them.
  ViewWeights directions() const;
};

/// The shortest range of whole bins that leaves out at most `kOutside` of the weight at either end, widened by a
/// degree.
ViewRange view_range(const SceneDomain& domain);
constexpr double kOutside = 1e-4;

/// Light this many times as concentrated as a domain's most concentrated light is outside of it.
constexpr double kSharperLight = 2;

}  // namespace velour

// Scene usage of a material: the views and lights under which scenes show it.
#pragma once

#include <array>
#include <cstdint>

#include "domain/surface_domain.h"
#include "sphere/view_range.h"

namespace velour {

/// The weight of a hit is its contribution to the image: the luminance of the path's throughput at the hit, in camera
/// rays.
struct SceneDomain {
  static constexpr int kViewBins = 90;  // theta_v, one degree each

  /// Weight of the hits, by the view's polar angle.
  std::array<double, kViewBins> view{};
  /// Camera rays that the weights were accumulated over, hits or not, in all frames.
  uint64_t camera_rays = 0;
  uint64_t frames = 0;
  /// Density of the most concentrated light seen, 1/sr: the density with which the renderer samples its direction from
  /// lights, which is one over the solid angle of a single light; infinite for a delta light.
  double light_density = 0;
  /// SHA-256 of everything observed in a frame; for several frames the word-wise sum, which does not depend on their
  /// order.
  std::array<uint64_t, 4> hash{};
  /// Only for materials that vary over the surface.
  SurfaceDomain surface;

  double weight() const;
  /// surface.views, or all_around(view) where these are unknown, as in files of earlier versions.
  ViewWeights directions() const;
};

/// The shortest range of whole bins that leaves out at most `kOutside` of the weight at either end, widened by a degree
/// at both ends.
ViewRange view_range(const SceneDomain& domain);
constexpr double kOutside = 1e-4;

/// Light more than this many times as concentrated as a domain's most concentrated light is outside the domain.
constexpr double kSharperLight = 2;

}  // namespace velour

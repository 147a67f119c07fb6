// What a density for f cos needs to know of a lobe of f: moments of what is left of it above the horizon.
#pragma once

#include "srbf/warped_lobe.h"

namespace velour {

/// Of a lobe at a view, luminance of f max(cos(theta_l), 0).
struct DrawnLobe {
  double mass;  // integral over the hemisphere
  /// The clipped cosine about the normal is a better density than the Gaussian below, as of lobes that are nearly
  /// constant.
  bool is_cosine;
  Vec3d center;      // of the Gaussian over psi that has its mean direction
  double bandwidth;  // and mean cosine
  Vec3d light_center;
  double light_bandwidth;  // the same over light directions
};

/// By quadrature over psi: without draws of random numbers, to about a per cent.
DrawnLobe drawn_lobe(const WarpedLobe& lobe, const Vec3d& wv);

}  // namespace velour

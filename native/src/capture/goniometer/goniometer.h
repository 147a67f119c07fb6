// Light traced over random surfaces, collected in bins.
#pragma once

#include <vector>

#include "base/progress.h"
#include "capture/goniometer/bins.h"

namespace velour {

/// The guide g(wl) g(wv) divided by wl.z wv.z, which is finite at the horizon. g(w) = cos / (cos + kappa sin), kappa =
/// alpha(phi) / (2 sqrt(pi)), falls towards the horizon as fast as the visibility of a Gaussian surface. Visibility is
/// collected as a ratio to the guide, so that bins may be wide where visibility falls steeply; the estimate converges
/// to the traced visibility for any guide.
double mirror_guide_over_cosines(const HeightFieldOptions& surface, const DirectionPair& pair);

/// Returns one element per batch, in order; the result does not depend on the number of threads.
///
/// A sample is a point of the surface, uniform over the mean plane, and a view of uniform theta_v and azimuth. If the
/// viewer sees the point, light is followed backwards from there: mirrored by metal, scattered with a cosine by the
/// base, until it escapes. The first mirror pair of a metal facet is counted in `tried` and `clear`; light that
/// escapes after any other history adds to `flux`. At the first facet of a clear surface, both the reflection and the
/// path through the body are followed; at later facets, one of them is chosen at random.
std::vector<GoniometerSums> run_goniometer(const GoniometerOptions& options, Progress& progress);

}  // namespace velour

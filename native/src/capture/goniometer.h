// Light traced over random surfaces, collected in bins.
#pragma once

#include <vector>

#include "capture/goniometer_bins.h"
#include "job/progress.h"

namespace velour {

/// Product over both directions of g(w) = cos / (cos + kappa sin), kappa = alpha(phi) / (2 sqrt(pi)): it falls to the
/// horizon as fast as a Gaussian surface hides itself there. Visibility is collected as a ratio to it, so that bins may
/// be wide where visibility falls steeply; the estimate converges to what is traced whatever the guide. This is g(wl)
/// g(wv) / (wl.z wv.z), which is finite at the horizon.
double mirror_guide_over_cosines(const HeightFieldOptions& surface, const DirectionPair& pair);

/// One element a batch, in order; the same for any number of threads.
///
/// A sample is a point of the surface, uniform over the mean plane, and a view of uniform theta_v and azimuth. If the
/// viewer sees the point, light is followed backwards from there: mirrored by metal, scattered with a cosine by the
/// base, until it escapes. The first mirror pair of a metal facet is counted in `tried` and `clear`; whatever escapes
/// after any other history adds to `flux`. At the first facet of a clear surface what is mirrored and what goes through
/// the body are both followed, later one of them by chance.
std::vector<GoniometerSums> run_goniometer(const GoniometerOptions& options, Progress& progress);

}  // namespace velour

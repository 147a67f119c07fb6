// Light traced over random surfaces, collected in bins.
#pragma once

#include <cstdint>
#include <vector>

#include "capture/coated_body.h"
#include "capture/conductor.h"
#include "capture/height_field.h"
#include "capture/pair_grid.h"
#include "capture/slope_bins.h"
#include "job/progress.h"

namespace velour {

struct GoniometerOptions {
  HeightFieldOptions surface;
  Conductor conductor{};     // of the facets; of a clear surface n alone
  Rgb base_albedo{0, 0, 0};  // of the diffuse base
  double base_share = 0.0;   // share of the mean plane over which the surface is base
  CoatedBody body;           // below a clear surface, whose interface the facets then are; it goes without base_share
  uint64_t seed = 0;
  int batches = 32;         // independent repetitions, from whose spread errors are estimated
  int tiles_per_batch = 2;  // surfaces a batch
  uint64_t samples_per_tile = 375'000;
  int threads = 0;         // 0: all
  bool reciprocal = true;  // count every path also with its two ends exchanged
};

/// The bins that one set of options asks for.
struct GoniometerBins {
  explicit GoniometerBins(const GoniometerOptions& options);
  SlopeBins slopes;
  PairGrid mirror;   // one reflection, off metal or an interface
  PairGrid metal;    // several of these, and nothing else
  PairGrid diffuse;  // any light that met the base or a body: it varies slowest
};

/// What was collected. Sums of two runs add.
struct GoniometerSums {
  explicit GoniometerSums(const GoniometerBins& bins);
  GoniometerSums& operator+=(const GoniometerSums& other);
  GoniometerSums& operator-=(const GoniometerSums& other);

  std::vector<double> metal_facets;  // a slope bin
  double facets = 0;                 // of both kinds
  std::vector<double> tried;         // a mirror bin: sum of mirror_guide over the mirror pairs of metal facets...
  std::vector<double> clear;         // ... and how many of them saw both the light and the viewer
  std::vector<double> metal_flux;    // a metal bin, 3 channels: what left towards wl, per unit of incident flux
  std::vector<double> diffuse_flux;  // a diffuse bin, likewise
  double samples = 0;
  uint64_t rays = 0;
  uint64_t lost = 0;  // paths given up: lost rays, and more than kMaxBounces reflections
};

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

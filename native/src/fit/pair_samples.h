// What the fits of analytic materials see of a material: pairs of directions, with the weight that a picture gives
// them.
#pragma once

#include <vector>

#include "brdf/measurement.h"
#include "job/progress.h"
#include "material/material.h"

namespace velour {

/// One pair of directions, both above the horizon.
struct PairSample {
  DirectionPair w;
  Rgb f_cos;     // >= 0
  float weight;  // >= 0
};

struct PairSamples {
  std::vector<PairSample> samples;  // none where all is black
  float floor = 0;  // what f cos is indistinguishable from 0: a thousandth of its mean; > 0 with samples
};

/// 18 views (72 where f depends on the azimuth) in the middles of five degrees, none within the margin of a held-out
/// one, 32 x 16 half vectors each; held-out samples of scattered measurements are not read. A view weighs
/// sin(2 theta_v) / albedo, its share in the picture of a sphere. Does not depend on `threads` (0: all).
PairSamples pair_samples(const Material& material, int threads, Progress& progress);
PairSamples pair_samples(const Measurement& measurement, int threads, Progress& progress);

}  // namespace velour

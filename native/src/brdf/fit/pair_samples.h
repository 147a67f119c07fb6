// Samples of a material for the fits of analytic materials: pairs of directions, weighted by their share in a picture.
#pragma once

#include <vector>

#include "base/progress.h"
#include "brdf/measure/measurement.h"
#include "material/material.h"

namespace velour {

/// One pair of directions, both above the horizon.
struct PairSample {
  DirectionPair w;
  Rgb f_cos;     // >= 0
  float weight;  // >= 0
};

struct PairSamples {
  std::vector<PairSample> samples;  // empty if all are black
  float floor = 0;  // f cos hardly distinguishable from 0: a thousandth of its mean; > 0 if there are samples
};

/// 18 views (72 if f depends on the azimuth) in the middles of 5-degree intervals, none within the margin of a held-out
/// one, with 32 x 16 half vectors each. Held-out irregular samples are not read. A view has the weight
/// sin(2 theta_v) / albedo, its share in the picture of a sphere. The result does not depend on `threads` (0: all).
PairSamples pair_samples(const Material& material, int threads, Progress& progress);
PairSamples pair_samples(const Measurement& measurement, int threads, Progress& progress);

}  // namespace velour

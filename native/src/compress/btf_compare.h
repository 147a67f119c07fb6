// Errors of a fitted BTF against a measurement (design of the metrics: docs/conventions.md).
#pragma once

#include <functional>
#include <vector>

#include "btf/btf_measurement.h"
#include "job/progress.h"

namespace velour {

struct BtfErrors {
  double psnr = 0;        // dB, of sRGB(clamp(f / p99, 0, 1))
  double ser = 0;         // sum of squared errors of f cos(theta_l) over the sum of its squares
  double brightness = 0;  // sum of the modelled f cos(theta_l) cos(theta_v) over that of the measured
  uint64_t pairs = 0;
};

/// The 99th percentile of all finite values of f, over texels, channels and pairs; exact.
double percentile_99(const BtfMeasurement& measurement, const Progress& progress);

/// f of every texel for a pair of directions, [row][column][channel].
using BtfImages = std::function<void(const DirectionPair&, std::vector<float>&)>;

/// Over all pairs of `truth` with equal weight. `p99`: of the measurement that was fitted, also for other pairs.
/// `images` is called from several threads. Entries of `truth` that are not finite are left out.
BtfErrors compare_btf(const BtfMeasurement& truth, const BtfImages& images, double p99, int threads,
                      Progress& progress);

}  // namespace velour

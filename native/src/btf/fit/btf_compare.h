// Errors of a fitted BTF against a measurement (design of the metrics: docs/engine/conventions.md).
#pragma once

#include <functional>
#include <vector>
#include "base/progress.h"
#include "btf/measure/btf_measurement.h"
#include "btf/model/factored_btf.h"
#include "model/model.h"

namespace velour {

struct BtfErrors {
  double psnr = 0;         // dB, of sRGB(clamp(f / p99, 0, 1))
  double ser = 0;          // sum of squared errors of f cos(theta_l) over the sum of its squares
  double relative_l2 = 0;  // of companded values: root of the sum of squared errors over the sum of squares
  double brightness = 0;   // sum of f cos(theta_l) cos(theta_v) of the model over that of the measurement
  uint64_t pairs = 0;
};

/// The 99th percentile of all finite values of f, over texels, channels and pairs; exact. If it is 0, the largest
/// value, or 1 if all are 0.
double percentile_99(const BtfMeasurement& measurement, const Progress& progress);

/// f of every texel for a pair of directions, [row][column][channel].
using BtfImages = std::function<void(const DirectionPair&, std::vector<float>&)>;

/// Parameters of the error metrics.
struct BtfJudgement {
  double p99 = 1;  // white: that of the fitted measurement, even for other pairs
  Companding companding = Companding::root;
};

/// Compares all pairs of `truth` with equal weight. `images` is called from several threads. Entries of `truth` that
/// are not finite are ignored.
BtfErrors compare_btf(const BtfMeasurement& truth, const BtfImages& images, const BtfJudgement& by, int threads,
                      Progress& progress);

// Images of a BTF's model, for all methods.

/// Computes f of every texel of the finest level for a pair. `body` must be of a BTF and outlive the result.
BtfImages images_of(const ModelBody& body);

}  // namespace velour

// The verdict on a fit, from pictures.
#pragma once

#include <optional>
#include "base/progress.h"
#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "model/verdict.h"

namespace velour {

/// FLIP over all pixels of the pictures that is still good (mean and 95th percentile) and still fair (mean). Fixed
/// before the shared materials were judged.
inline constexpr double kGoodMean = 0.04, kGoodPercentile = 0.15, kFairMean = 0.1;

/// Compares pictures of `material`, for any scene, with pictures of the measurement (brdf/verdict/pictures.h): good
/// within kGoodMean and kGoodPercentile, fair within kFairMean, otherwise poor. Nothing if the measurement covers no
/// view of the pictures. The result does not depend on `threads` (0: all).
std::optional<Verdict> judge_look(const Measurement& measurement, const Material& material, int threads,
                                  Progress& progress);

}  // namespace velour

// The verdict of pictures of a measurement and of its model beside each other.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>
#include "base/progress.h"
#include "image/flip.h"
#include "model/records.h"

namespace velour {

inline constexpr float kPhotographicGray = 0.18f;

/// Pictures of one thing in one light, exposed so that the measurement's mean luminance is kPhotographicGray.
struct PicturePair {
  LinearPicture measured, shown;  // of positive values; displays cut them off at 1
  double exposure = 1;            // factor of both
  std::vector<uint32_t> object;   // pixels that are compared
  std::vector<float> view_angle;  // of each of these, radians
  double luminance_ratio = 1;     // of the means over the object before values are cut off at 1: shown over measured
};

/// FLIP over all pixels of the pictures that is still good (mean and 95th percentile) and still fair (mean). Fixed
/// before the shared materials were judged.
inline constexpr double kGoodMean = 0.04, kGoodPercentile = 0.15, kFairMean = 0.1;

/// Good within kGoodMean and kGoodPercentile, fair within kFairMean, otherwise poor; without a reason. Nothing if no
/// pixel is compared.
std::optional<Verdict> verdict_of(const std::vector<PicturePair>& pairs, const Progress& progress);

/// Whether a mean FLIP that remains without a difference makes that difference the reason of the verdict.
bool explains(double remaining, const Verdict& verdict);

/// Adds the reason to the verdict_of() these pictures: what is wrong everywhere, otherwise the part that stands out.
void explain_look(const std::vector<PicturePair>& pairs, const Progress& progress, Verdict& verdict);

}  // namespace velour

// The verdict on a fit, from pictures of a measurement and of a material beside each other.
#pragma once

#include <memory>
#include <optional>
#include <vector>
#include "base/progress.h"
#include "brdf/measure/measurement.h"
#include "image/flip.h"
#include "material/material.h"
#include "model/model.h"
#include "model/records.h"

namespace velour {

/// Pictures of one shape in one light, exposed so that the measurement's mean luminance is photographic gray.
struct PicturePair {
  LinearPicture measured, shown;  // of positive values; displays cut them off at 1
  double exposure = 1;            // factor of both
  std::vector<uint32_t> object;   // pixels of the shape whose views are measured
  std::vector<float> view_angle;  // of each of these, radians
  double luminance_ratio = 1;     // of the means over the object before values are cut off at 1: shown over measured
};

/// What the material is compared with.
enum class Against : uint8_t {
  measurement,
  reciprocal_mean,  // of f(wl, wv) and f(wv, wl), which are equal for a real surface: less noise
};

/// The ball and the ring in each of the three surroundings. No random numbers: measurement and material are summed over
/// the same directions, so that what these miss is missed in both. Views are rounded to the middles of about two
/// degrees. Pairs that the measurement does not cover count in neither picture. The result
/// does not depend on `threads` (0: all).
std::vector<PicturePair> picture_pairs(const Measurement& measurement, const Material& material, Against against,
                                       int threads, Progress& progress);

/// FLIP over all pixels of the pictures that is still good (mean and 95th percentile) and still fair (mean). Fixed
/// before the shared materials were judged.
inline constexpr double kGoodMean = 0.04, kGoodPercentile = 0.15, kFairMean = 0.1;

/// Compares pictures of `material`, for any scene, with pictures of the measurement (picture_pairs): good
/// within kGoodMean and kGoodPercentile, fair within kFairMean, otherwise poor. Nothing if the measurement covers no
/// view of the pictures. `explained`: with the reason if it is not good, which takes as long again. The result does not
/// depend on `threads` (0: all).
std::optional<Verdict> judge_look(const Measurement& measurement, const Material& material, bool explained, int threads,
                                  Progress& progress);

/// Lowers the verdict on a fit of irregular samples by what pictures of their interpolation cannot show: to poor if
/// they are of an anisotropic surface, to fair if the model misses held-out samples at some view as black would.
void lower_for_samples(const FitRecord& record, Verdict& verdict);

}  // namespace velour

// The verdict on the fit of a BRDF, from pictures of a measurement and of a material beside each other.
#pragma once

#include <memory>
#include <optional>
#include <vector>
#include "base/progress.h"
#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "model/model.h"
#include "verdict/look.h"

namespace velour {

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

/// Compares pictures of `material`, for any scene, with pictures of the measurement (picture_pairs). Nothing if the
/// measurement covers no view of the pictures. `explained`: with the reason if it is not good, which takes as long
/// again. The result does not depend on `threads` (0: all).
std::optional<Verdict> judge_look(const Measurement& measurement, const Material& material, bool explained, int threads,
                                  Progress& progress);

/// Lowers the verdict on a fit of irregular samples by what pictures of their interpolation cannot show: to poor if
/// they are of an anisotropic surface, to fair if the model misses held-out samples at some view as black would.
void lower_for_samples(const FitRecord& record, Verdict& verdict);

}  // namespace velour

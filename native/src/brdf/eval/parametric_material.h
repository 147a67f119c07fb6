// Materials sampled from a parametric model: the model itself, or a raw measurement.
#pragma once

#include <memory>
#include "brdf/measure/measurement.h"
#include "brdf/model/parametric_brdf.h"
#include "material/material.h"
#include "math/sphere/directions.h"

namespace velour {

/// f and samples of the model. Throws Error(invalid_argument) when it has more lobes than WarpedMixture::kCapacity.
std::shared_ptr<const Material> make_parametric_material(const std::shared_ptr<const ParametricBrdf>& brdf);

/// f of the measurement, samples of the model: unbiased whatever the model's error (reference mode).
std::shared_ptr<const Material> make_measured_material(std::shared_ptr<const Measurement> measurement,
                                                       const std::shared_ptr<const ParametricBrdf>& proposal);

// f of a raw measurement at a batch of light directions: reference mode.

/// f in 1/sr without cosine; 0 below the horizon, where the measurement does not cover the pair, and for negative
/// channels. No allocation.
void measured_values(const Measurement& measurement, const Vec3& wv, const DirectionBatch& wl, RgbBatch& f);

}  // namespace velour

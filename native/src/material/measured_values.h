// f of a raw measurement at a batch of light directions: reference mode.
#pragma once

#include "brdf/measurement.h"
#include "sphere/direction_batch.h"

namespace velour {

/// f in 1/sr without cosine; 0 below the horizon, where the measurement does not cover the pair, and for negative
/// channels. No allocation.
void measured_values(const Measurement& measurement, const Vec3& wv, const DirectionBatch& wl, RgbBatch& f);

}  // namespace velour

// What the user of a fit is told about the measurement itself: no fit mends it.
#pragma once

#include "brdf/measurement.h"
#include "fit/compare.h"

namespace velour {

/// Appends to `record.warnings` a sentence, with its numbers, for each of: many invalid entries, few scattered samples,
/// scattered samples of an anisotropic surface, noise above the tolerance, highlights too narrow for the lights of the
/// error, lights that are not covered, no light sent back at all or next to none (a wrong scale), and broken
/// reciprocity. `record` holds everything but the warnings.
void warn_of_measurement(const Measurement& measurement, const Comparison& errors, FitRecord& record);

}  // namespace velour

// Warnings about the measurement itself, which no fit can fix.
#pragma once

#include "brdf/measurement.h"
#include "fit/compare.h"

namespace velour {

/// Appends to `record.warnings` a sentence, with numbers, for each of: many invalid entries, few irregular samples,
/// irregular samples of an anisotropic surface, noise above the tolerance, highlights too narrow for the lights of the
/// error, lights that are not covered, no covered view, no or almost no reflected light (a wrong scale), and broken
/// reciprocity. All other fields of `record` must be set.
void warn_of_measurement(const Measurement& measurement, const Comparison& errors, FitRecord& record);

}  // namespace velour

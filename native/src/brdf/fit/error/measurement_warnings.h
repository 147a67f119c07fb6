// Warnings about the measurement itself, which no fit can fix.
#pragma once

#include <optional>
#include <span>
#include "brdf/fit/error/compare.h"
#include "brdf/measure/measurement.h"

namespace velour {

/// Appends to `record.warnings` one warning for each of: many invalid entries, few irregular samples,
/// irregular samples of an anisotropic surface, noise above the tolerance, lights that are not covered, no covered
/// view, no or almost no reflected light (a wrong scale), and broken reciprocity. All other fields of `record` must be
/// set.
void warn_of_measurement(const Measurement& measurement, const Comparison& errors, FitRecord& record);

// Tests whether irregular samples are of an isotropic surface.

/// Medians of |log(f1 / f2)| over the luminances of pairs of samples whose half and difference angles [R98] agree
/// within three degrees. For an isotropic surface both are similar; for a brushed one `turned` is larger.
struct AzimuthSpread {
  double alike;   // azimuths of the half vectors within 15 degrees of each other, modulo half a turn
  double turned;  // 30 degrees or more apart
  size_t turned_pairs;
};

/// Nothing if there are fewer than 100 such pairs of either kind, too few to tell.
std::optional<AzimuthSpread> azimuth_spread(std::span<const IrregularSample> samples);

}  // namespace velour

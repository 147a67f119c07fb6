// Tests whether irregular samples are of an isotropic surface.
#pragma once

#include <optional>
#include <span>

#include "brdf/measurement.h"

namespace velour {

/// Medians of |log(f1 / f2)| over the luminances of pairs of samples whose half and difference angles [R98] agree
/// within three degrees. For an isotropic surface both are similar; for a brushed one `turned` is larger.
struct AzimuthSpread {
  double alike;   // azimuths of the half vectors within 15 degrees of each other, modulo half a turn
  double turned;  // 30 degrees or more apart
  size_t turned_pairs;
};

/// Nothing if there are fewer than 100 such pairs of either kind, too few to tell.
std::optional<AzimuthSpread> azimuth_spread(std::span<const ScatteredSample> samples);

}  // namespace velour

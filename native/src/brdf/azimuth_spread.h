// Whether scattered samples are of a surface that looks the same from every azimuth.
#pragma once

#include <optional>
#include <span>

#include "brdf/measurement.h"

namespace velour {

/// Medians of |log f1 / f2| of the luminances of two samples whose half and difference angles [R98] agree within three
/// degrees: of an isotropic surface both are alike, of a brushed one `turned` is larger.
struct AzimuthSpread {
  double alike;   // half vectors within 15 degrees of azimuth of each other, modulo half a turn
  double turned;  // 30 degrees or more apart
  size_t turned_pairs;
};

/// Nothing where the samples have fewer than 100 such pairs of either sort: they do not tell.
std::optional<AzimuthSpread> azimuth_spread(std::span<const ScatteredSample> samples);

}  // namespace velour

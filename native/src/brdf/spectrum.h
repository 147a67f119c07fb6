// Converts reflectance spectra to colors.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Weights w of samples s at `wavelengths` (nanometers, increasing) so that sum w_i s_i is linear Rec. 709.
///
/// The spectrum is linear between its samples and constant outside them, seen by the CIE 1931 observer under the
/// equal-energy illuminant, and adapted to Rec. 709's white (Bradford): a flat reflectance of 1 is exactly (1, 1, 1).
std::vector<Vec3d> rec709_weights(std::span<const double> wavelengths);

/// Linear Rec. 709 of XYZ values whose white is (1, 1, 1), adapted in the same way.
Rgb rec709_of_xyz(const Vec3d& xyz);

/// The weighted sum; NaN if a sample is NaN.
Rgb rec709_of(std::span<const Vec3d> weights, std::span<const float> samples);

/// Throws Error(bad_data) unless `wavelengths` are finite, in 100..5000 nm and strictly increasing. `where` (file and
/// field) begins the message.
void check_wavelengths(std::span<const double> wavelengths, const std::string& where);

}  // namespace velour

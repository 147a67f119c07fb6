// Weights that make the squared error of f cos reflect what pictures show.
#pragma once

#include <span>
#include <vector>

#include "fit/slice_samples.h"

namespace velour {

/// Target of the relative error of pictures. Half a lightness step on uniform gray is 5 % of its luminance.
inline constexpr double kPictureGoal = 0.1;

/// Factors for the weights of the samples that make a squared error relative to the measurement, for bright and dim
/// samples alike, down to a tenth of the view's mean. A light may show the highlight of a material or only its tail,
/// and eyes see ratios; the squared error of f cos is that of the highlight alone. Scaled so that the weighted squared
/// luminance of the measurement sums to 1. Empty if all samples are black.
std::vector<float> picture_weights(std::span<const SliceSample> samples);

}  // namespace velour

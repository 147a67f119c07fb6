// How much a sample of f cos shows in pictures, against what it is worth in the squared error of f cos.
#pragma once

#include <span>
#include <vector>

#include "fit/slice_samples.h"

namespace velour {

/// The relative error that pictures are to keep to: half a lightness step on even grey is 5 % of its luminance.
inline constexpr double kPictureGoal = 0.1;

/// Factors of the samples' weights that make a squared error one of the ratio to the measurement, bright or dim alike,
/// down to a tenth of the view's mean: a lamp shows of a material what it shines on, a highlight or its tail, and eyes
/// see ratios. The squared error of f cos itself is that of the highlight alone. Scaled so that the measurement's own
/// squared luminance sums to 1. Empty where all is black.
std::vector<float> picture_weights(std::span<const SliceSample> samples);

}  // namespace velour

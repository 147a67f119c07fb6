#include "brdf/fit/slice_samples.h"

namespace velour {

SliceSamples::SliceSamples(std::span<const SliceSample> samples) : count_(samples.size()) {
  const size_t padded = (count_ + kPadding - 1) / kPadding * kPadding;
  for (AlignedFloats* a : {&x_, &y_, &sqrt_weight_, &target_[0], &target_[1], &target_[2]}) a->assign(padded, 0.0f);
  z_.assign(padded, 1.0f);  // padding has unit length, so that no kernel divides by 0
  for (size_t i = 0; i < count_; ++i) {
    const SliceSample& s = samples[i];
    x_[i] = s.wl.x;
    y_[i] = s.wl.y;
    z_[i] = s.wl.z;
    sqrt_weight_[i] = std::sqrt(s.weight);
    for (int c = 0; c < 3; ++c) {
      target_[c][i] = sqrt_weight_[i] * s.value[c];
      energy_[c] += static_cast<double>(target_[c][i]) * target_[c][i];
    }
    const double y = luminance(s.value);
    luminance_energy_ += s.weight * y * y;
    const double clamped = luminance(glm::max(s.value, Rgb(0))) - y;
    gamut_error_sq_ += s.weight * clamped * clamped;
  }
}

void SliceSamples::scale_weights(std::span<const float> factors) {
  for (size_t i = 0; i < count_; ++i) {
    const float root = std::sqrt(factors[i]);
    sqrt_weight_[i] *= root;
    for (AlignedFloats& target : target_) target[i] *= root;
  }
}

double SliceSamples::gamut_error() const {
  return luminance_energy_ > 0 ? std::sqrt(gamut_error_sq_ / luminance_energy_) : 0.0;
}

}  // namespace velour

// Fresnel reflectance of smooth surfaces, as a color.
#pragma once

#include <array>
#include <span>

#include "sphere/vec.h"

namespace velour {

/// Complex index of refraction n + i k of the medium below a surface, relative to the medium above. n = 0 reflects
/// everything, k = 0 is a dielectric.
struct RefractiveIndex {
  double n = 0.0;
  double k = 0.0;
};

/// Unpolarized Fresnel reflectance in [0, 1], for cos_theta in [0, 1] between the normal and the ray (Born and Wolf,
/// Principles of Optics, 14.2).
double fresnel_reflectance(const RefractiveIndex& index, double cos_theta);

/// Fresnel reflectance as a color: linear Rec. 709, each channel in [0, 1]. Tabulated over the cosine, within 1e-4.
/// Neither polarization nor the spectrum is carried from one reflection to the next: colors multiply.
class Reflectance {
 public:
  /// Gray: the index is the same at all wavelengths.
  explicit Reflectance(const RefractiveIndex& index);

  /// Color of the spectrum that `indices` give at `wavelengths` (nanometers, ascending), converted like measured
  /// spectra (brdf/spectrum.h). Channels outside the Rec. 709 gamut, such as gold's red of 1.04, are clamped to [0, 1].
  Reflectance(std::span<const double> wavelengths, std::span<const RefractiveIndex> indices);

  /// `cos_theta`: between the normal and the ray, clamped to [0, 1] against rounding.
  Rgb at(float cos_theta) const {
    const float place = static_cast<float>(kSteps) * glm::clamp(cos_theta, 0.0f, 1.0f);
    const auto below = static_cast<size_t>(glm::min(place, static_cast<float>(kSteps - 1)));
    return glm::mix(nodes_[below], nodes_[below + 1], place - static_cast<float>(below));
  }

 private:
  static constexpr size_t kSteps = 512;
  std::array<Rgb, kSteps + 1> nodes_;  // at equal steps of the cosine
};

}  // namespace velour

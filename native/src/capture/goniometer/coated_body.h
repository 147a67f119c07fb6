// The body below a facet of a clear surface: pigment, metal flakes, or both.
#pragma once

#include <array>
#include <optional>
#include <span>
#include "capture/goniometer/height_field.h"
#include "math/sphere/random.h"
#include "math/sphere/vec.h"

namespace velour {

// Fresnel reflectance of smooth surfaces, as a color.

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
  /// spectra (brdf/measure/spectrum.h). Channels outside the Rec. 709 gamut, such as gold's red of 1.04, are clamped to
  /// [0, 1].
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

/// A clear dielectric over a body of pigment and flakes.
struct CoatedBody {
  double ior;                    // of the dielectric
  Reflectance flakes;            // of the flakes' metal below the dielectric
  double flake_roughness = 0.2;  // Beckmann alpha of the flakes' own slopes
  Rgb pigment_albedo{0, 0, 0};
  double pigment_share = 1.0;  // of the body's area

  bool has_flakes() const { return pigment_share < 1.0; }
};

/// Reflectance of the interface, from air.
Reflectance interface_of(const CoatedBody& body);

/// A random surface of flakes with patches of pigment, below a clear surface. The relief of both is small compared with
/// their distance and with each other's tiles, so light reaches a random point of this surface and leaves through the
/// facet that it entered by. Pigment alone is flat. Immutable after construction.
class BodyBelow {
 public:
  /// `stream` and `stream + 1`: random number streams of the surface, used by no other surface.
  BodyBelow(const CoatedBody& body, uint64_t seed, uint64_t stream);

  /// Follows light that has passed the interface until it leaves again; returns its direction in air, in the facet's
  /// frame. `arriving`: unit, back along the ray, in air, in the same frame. Multiplies `weight` by the remaining
  /// share; 0: nothing came out.
  Vec3 through(Vec3 arriving, Rgb& weight, RandomStream& random) const;

 private:
  Vec3 scatter(const Vec3& inside, Rgb& weight, RandomStream& random) const;

  CoatedBody body_;
  Reflectance interface_;
  std::optional<PeriodicTile> surface_;
};

}  // namespace velour

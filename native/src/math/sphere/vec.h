// Small vector types of the whole library.
//
// Directions are unit vectors that point away from the surface. Unless a name ends in `_world` they live in the local
// shading frame: +z is the normal, +x the tangent, +y = cross(+z, +x). `wl` points to the light, `wv` to the viewer.
#pragma once

#include <glm/glm.hpp>

namespace velour {

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec3d = glm::dvec3;
using Mat2 = glm::mat2;  // column-major, as GLM
using Mat3 = glm::mat3;  // column-major
using Rgb = glm::vec3;   // linear Rec. 709 unless stated

inline constexpr float kPi = 3.14159265358979323846f;
inline constexpr double kPiD = 3.14159265358979323846;

/// (sqrt(5) - 1) / 2: its multiples modulo 1 are spread evenly, however many there are.
inline constexpr double kGoldenRatio = 0.6180339887498949;

/// Weights of the channels of linear Rec. 709 in its luminance.
inline constexpr double kLuminance[3] = {0.2126, 0.7152, 0.0722};

/// Rec. 709 luminance of linear `c`.
inline float luminance(const Rgb& c) {
  return static_cast<float>(kLuminance[0]) * c.r + static_cast<float>(kLuminance[1]) * c.g +
         static_cast<float>(kLuminance[2]) * c.b;
}

constexpr float radians_from(float degrees) { return degrees * (kPi / 180.0f); }
constexpr double radians_from(double degrees) { return degrees * (kPiD / 180.0); }

/// Unit direction of polar angle `theta` and azimuth `phi` (radians) in the local frame.
inline Vec3 direction(float theta, float phi) {
  const float s = std::sin(theta);
  return {s * std::cos(phi), s * std::sin(phi), std::cos(theta)};
}

/// The two directions of a BRDF look-up, by name, so that they cannot be swapped unnoticed.
struct DirectionPair {
  Vec3 wl;
  Vec3 wv;
};

}  // namespace velour

// Where half vectors lie in the units of RGL tables, for several directions of light at once.
#pragma once

#include <span>

#include "sphere/vec.h"

namespace velour {

/// A view, mirrored into the measured sector, and how light goes there with it.
struct RglView {
  Vec3 wv;
  Vec2 flip{1, 1};                 // of x and y of the light
  float cos_phi = 1, sin_phi = 0;  // azimuths of half vectors are taken from here
};

/// For each of up to 16 `wl` the (theta, phi) of its half vector in the paper's units: sqrt(2 theta / pi) and phi / 2
/// pi in [0, 1), half a turn at 0. Absolute error 1e-6. Run-time dispatched SIMD.
inline constexpr size_t kRglPositions = 16;
void half_vector_positions(const RglView& view, std::span<const Vec3> wl, Vec2* positions);

}  // namespace velour

// Half vectors in the units of RGL tables, for several light directions at once.
#pragma once

#include <span>

#include "math/sphere/vec.h"

namespace velour {

/// A view, mirrored into the measured sector, and the same map for light directions.
struct RglView {
  Vec3 wv;
  Vec2 flip{1, 1};                 // signs for x and y of the light
  float cos_phi = 1, sin_phi = 0;  // reference azimuth of half vectors
};

/// For each of up to 16 `wl` the (theta, phi) of its half vector in the paper's units: sqrt(2 theta / pi) and (phi +
/// pi) / 2 pi in [0, 1). Absolute error 1e-6. SIMD, dispatched at run time.
inline constexpr size_t kRglPositions = 16;
void half_vector_positions(const RglView& view, std::span<const Vec3> wl, Vec2* positions);

}  // namespace velour

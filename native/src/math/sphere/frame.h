// Orthonormal frames about a direction.
#pragma once

#include <algorithm>
#include "math/sphere/directions.h"
#include "math/sphere/vec.h"

namespace velour {

/// Columns are tangent x, tangent y and the axis z. `to_local(v) = transpose(m) v`.
struct Frame {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  /// Frame about unit `axis`; continuous except where axis.z changes sign (Duff et al. 2017, JCGT 6(1), Listing 3).
  static Frame about(const Vec3& axis) {
    const float sign = std::copysign(1.0f, axis.z);
    const float a = -1.0f / (sign + axis.z);
    const float b = axis.x * axis.y * a;
    return {
        {1.0f + sign * axis.x * axis.x * a, sign * b, -sign * axis.x}, {b, sign + axis.y * axis.y * a, -axis.y}, axis};
  }

  Vec3 to_world(const Vec3& v) const { return v.x * x + v.y * y + v.z * z; }
  Vec3 to_local(const Vec3& v) const { return {glm::dot(v, x), glm::dot(v, y), glm::dot(v, z)}; }
};

/// Smallest rotation that takes unit `from` to unit `to`. Opposite directions rotate about an axis normal to `from`.
Mat3 rotation_between(const Vec3& from, const Vec3& to);

// Sampling of both sides of a surface with samplers of one hemisphere.

/// The mirror direction of `w` about the normal.
inline Vec3 reflected(const Vec3& w) { return {-w.x, -w.y, w.z}; }

/// Reflects `w` in the plane z = 0.
inline Vec3 mirrored(const Vec3& w) { return {w.x, w.y, -w.z}; }

/// Samples a direction for each of `u`; with probability `share` it is mirrored. `draw`(whether they will be mirrored,
/// numbers, batch to fill) is called at most once per side, with numbers remapped to [0, 1)^2. Mixtures return
/// (0, 0, -1) where a half vector faces away; here that would be a valid direction, so it becomes (0, 0, 0).
template <typename Draw>
void sample_sides(std::span<const Vec2> u, float share, DirectionBatch& wl, const Draw& draw) {
  constexpr float kBelowOne = 0x1.fffffep-1f;
  Vec2 numbers[2][DirectionBatch::kCapacity];
  int place[2][DirectionBatch::kCapacity];
  size_t count[2] = {0, 0};
  for (size_t i = 0; i < u.size(); ++i) {
    const bool beyond = u[i].x < share;
    const float x = beyond ? u[i].x / share : (u[i].x - share) / (1 - share);
    place[beyond][count[beyond]] = static_cast<int>(i);
    numbers[beyond][count[beyond]++] = {std::min(x, kBelowOne), u[i].y};
  }
  for (const bool beyond : {false, true}) {
    if (count[beyond] == 0) continue;
    DirectionBatch drawn;
    draw(beyond, std::span<const Vec2>(numbers[beyond], count[beyond]), drawn);
    for (size_t i = 0; i < count[beyond]; ++i) {
      const Vec3 w = drawn.get(static_cast<int>(i));
      const bool none = w == Vec3(0, 0, -1);
      wl.set(place[beyond][i], none ? Vec3(0.0f) : beyond ? mirrored(w) : w);
    }
  }
  wl.count = static_cast<int>(u.size());
}

}  // namespace velour

// What a shader does with the tables of realtime/, in C++: addon/velour/realtime has the same in GLSL.
#pragma once

#include <algorithm>
#include <cmath>

#include "math/sphere/frame.h"
#include "math/sphere/warp.h"
#include "realtime/light_map.h"
#include "realtime/lobe_rows.h"

namespace velour::test {

inline Vec3 bilinear(const TablePixels& map, const Vec2& at) {
  const Vec2 low(std::floor(at.x), std::floor(at.y)), t = at - low;
  const auto pixel = [&](int x, int y) {
    const float* p = map.at(static_cast<uint32_t>(low.x) + static_cast<uint32_t>(x),
                            static_cast<uint32_t>(low.y) + static_cast<uint32_t>(y));
    return Vec3(p[0], p[1], p[2]);
  };
  return (1 - t.y) * ((1 - t.x) * pixel(0, 0) + t.x * pixel(1, 0)) +
         t.y * ((1 - t.x) * pixel(0, 1) + t.x * pixel(1, 1));
}

inline Vec3 light_of_level(const TablePixels& map, int level, const Vec3& w) {
  const float* entry = map.at(static_cast<uint32_t>(level), 0);
  return bilinear(map, Vec2(entry[0], entry[1]) + octahedral_from(w) * entry[2] - 0.5f);
}

/// The light's mean over the lobe of `level` about unit `w`.
inline Vec3 mean_light(const TablePixels& map, float level, const Vec3& w) {
  const int below = static_cast<int>(level);
  const float t = level - static_cast<float>(below);
  const Vec3 low = light_of_level(map, below, w);
  return t > 0 ? (1 - t) * low + t * light_of_level(map, below + 1, w) : low;
}

struct ShadedLobe {
  Vec3 center;
  float level;
  Vec3 color;
};

/// Lobe `j` of the blend of places at (x, y) of the grid of views; y is 0 of isotropic models.
inline ShadedLobe lobe_at(const LobeRows& rows, Vec2 place, int j) {
  if (!rows.blends) place = {std::round(place.x), std::round(place.y)};
  const auto most = static_cast<float>(rows.side - 2);
  const Vec2 low(std::clamp(std::floor(place.x), 0.0f, most), std::clamp(std::floor(place.y), 0.0f, most));
  const Vec2 t = place - low;
  float sum[8] = {};
  for (int dy = 0; dy < (rows.isotropic ? 1 : 2); ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      const float weight = (dx ? t.x : 1 - t.x) * (rows.isotropic ? 1 : (dy ? t.y : 1 - t.y));
      const int row = (static_cast<int>(low.y) + dy) * rows.side + static_cast<int>(low.x) + dx;
      const float* from = rows.pixels.at(static_cast<uint32_t>(2 * j), static_cast<uint32_t>(row));
      for (int c = 0; c < 8; ++c) sum[c] += weight * from[c];
    }
  }
  return {glm::normalize(Vec3(sum[0], sum[1], sum[2])), sum[3], {sum[4], sum[5], sum[6]}};
}

/// Reflected radiance towards unit `wv` of the world.
inline Vec3 shaded(const LobeRows& rows, const TablePixels& map, Frame frame, const Vec3& wv) {
  const Vec3 local = frame.to_local(wv);
  const float sine = std::sqrt(local.x * local.x + local.y * local.y);
  const float radius = std::atan2(sine, local.z) / (kPi / 2);
  const auto last = static_cast<float>(rows.side - 1);
  Vec2 place(radius * last, 0);
  const Vec2 azimuth = sine > 0 ? Vec2(local.x, local.y) / sine : Vec2(1, 0);
  if (rows.isotropic) {
    const Vec3 x = azimuth.x * frame.x + azimuth.y * frame.y;
    frame = {x, glm::cross(frame.z, x), frame.z};
  } else {
    place = 0.5f * (radius * azimuth + 1.0f) * last;
  }
  Vec3 sum(0.0f);
  for (int j = 0; j < rows.lobes; ++j) {
    const ShadedLobe lobe = lobe_at(rows, place, j);
    sum += lobe.color * mean_light(map, lobe.level, frame.to_world(lobe.center));
  }
  return sum;
}

}  // namespace velour::test

#include "brdf/verdict/surroundings.h"

#include <algorithm>
#include <cmath>

namespace velour {

namespace {

constexpr int kSide = 128, kSamples = 2;  // of the finest level; per texel and axis

float soft_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3 - 2 * t);
}

/// 1 within a rectangle seen in the direction `center`, whose half sides are tangents of angles; soft borders.
float box(const Vec3& w, const Vec3& center, float half_width, float half_height) {
  constexpr float kSoft = 0.04f;
  const Vec3 z = glm::normalize(center), x = glm::normalize(glm::cross(Vec3(0, 1, 0), z)), y = glm::cross(z, x);
  const float depth = glm::dot(w, z);
  if (depth <= 0) return 0;
  const float u = std::abs(glm::dot(w, x)) / depth, v = std::abs(glm::dot(w, y)) / depth;
  return (1 - soft_step(half_width - kSoft, half_width + kSoft, u)) *
         (1 - soft_step(half_height - kSoft, half_height + kSoft, v));
}

/// 1 within `radius` radians of `center`, soft by a third of it.
float disk(const Vec3& w, const Vec3& center, float radius) {
  const float angle = std::acos(std::clamp(glm::dot(w, glm::normalize(center)), -1.0f, 1.0f));
  return 1 - soft_step(radius * 0.83f, radius * 1.17f, angle);
}

Rgb studio(const Vec3& w) {
  Rgb out = Rgb(0.06f) + Rgb(0.1f) * soft_step(-1, 1, w.y);
  out += Rgb(11, 10.5f, 10) * box(w, {-0.7f, 0.7f, 0.6f}, 0.45f, 0.45f);
  out += Rgb(1.6f, 1.7f, 1.9f) * box(w, {0.9f, 0.1f, 0.5f}, 0.8f, 1.0f);
  out += Rgb(9) * box(w, {0.5f, 0.35f, -0.8f}, 0.12f, 1.1f);
  out += Rgb(5) * box(w, {-0.9f, 0, -0.5f}, 0.1f, 0.8f);
  return out;
}

Rgb clear_sky(const Vec3& w) {
  const Rgb ground(0.22f, 0.18f, 0.14f), zenith(0.22f, 0.38f, 0.8f), horizon(0.75f, 0.8f, 0.9f);
  const Rgb sky = glm::mix(horizon, zenith, std::pow(std::max(w.y, 0.0f), 0.5f));
  const Vec3 sun(0.45f, 0.6f, 0.65f);
  const float about_sun = std::max(glm::dot(w, glm::normalize(sun)), 0.0f);
  return glm::mix(ground, sky, soft_step(-0.03f, 0.03f, w.y)) + Rgb(190, 175, 150) * disk(w, sun, 0.045f) +
         Rgb(1.2f, 1.1f, 1) * std::pow(about_sun, 24.0f);
}

Rgb street_at_night(const Vec3& w) {
  struct Lamp {
    Vec3 towards;
    float radius;
    Rgb color;
  };
  static constexpr std::array<Lamp, 8> kLamps{{{{-0.8f, 0.45f, 0.4f}, 0.10f, {30, 18, 8}},
                                               {{-0.3f, 0.3f, 0.9f}, 0.05f, {60, 40, 20}},
                                               {{0.5f, 0.55f, 0.6f}, 0.08f, {35, 22, 10}},
                                               {{0.95f, 0.2f, 0.1f}, 0.12f, {4, 14, 24}},
                                               {{0.2f, -0.25f, 0.9f}, 0.06f, {22, 3, 3}},
                                               {{-0.6f, -0.1f, -0.7f}, 0.12f, {20, 16, 12}},
                                               {{0.4f, 0.15f, -0.9f}, 0.09f, {8, 26, 10}},
                                               {{0.0f, 0.95f, -0.2f}, 0.16f, {7, 8, 11}}}};
  Rgb out = glm::mix(Rgb(0.05f, 0.045f, 0.04f), Rgb(0.03f, 0.05f, 0.12f), soft_step(-0.2f, 0.4f, w.y));
  out += Rgb(0.5f, 0.35f, 0.25f) * std::exp(-30 * w.y * w.y);  // lit walls about the horizon
  for (const Lamp& lamp : kLamps) out += lamp.color * disk(w, lamp.towards, lamp.radius);
  return out;
}

/// The direction of a point of the octahedral map, coordinates in [-1, 1].
Vec3 unfolded(float u, float v) {
  Vec3 w(u, v, 1 - std::abs(u) - std::abs(v));
  if (w.z < 0) w = {std::copysign(1 - std::abs(v), u), std::copysign(1 - std::abs(u), v), w.z};
  return glm::normalize(w);
}

Surroundings::Radiance radiance(const Vec3& w) {
  const Rgb all[Surroundings::kCount]{studio(w), clear_sky(w), street_at_night(w)};
  Surroundings::Radiance out{};
  for (size_t e = 0; e < Surroundings::kCount; ++e) {
    for (size_t c = 0; c < 3; ++c) out[4 * e + c] = all[e][static_cast<int>(c)];
  }
  return out;
}

void add(Surroundings::Radiance& sum, const Surroundings::Radiance& value, float weight) {
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += weight * value[i];
}

Surroundings::Radiance texel_mean(int x, int y) {
  Surroundings::Radiance sum{};
  for (int i = 0; i < kSamples * kSamples; ++i) {
    const auto at = [](int texel, int sample) {
      return 2 * (static_cast<float>(texel) + (static_cast<float>(sample) + 0.5f) / kSamples) / kSide - 1;
    };
    add(sum, radiance(unfolded(at(x, i % kSamples), at(y, i / kSamples))), 1.0f / (kSamples * kSamples));
  }
  return sum;
}

}  // namespace

Surroundings::Surroundings() {
  const auto at = [](int side, int x, int y) { return static_cast<size_t>(y * side + x); };
  levels_.push_back({kSide, {}});
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) levels_[0].texels.push_back(texel_mean(x, y));
  }
  for (int side = kSide / 2; side >= 2; side /= 2) {
    const Level& finer = levels_.back();
    Level level{side, std::vector<Radiance>(at(side, 0, side))};
    for (int y = 0; y < 2 * side; ++y) {
      for (int x = 0; x < 2 * side; ++x) {
        add(level.texels[at(side, x / 2, y / 2)], finer.texels[at(2 * side, x, y)], 0.25f);
      }
    }
    levels_.push_back(std::move(level));
  }
}

int Surroundings::level_of(double solid_angle) const {
  const double texels = solid_angle * kSide * kSide / (4 * kPiD);
  return std::clamp(static_cast<int>(std::lround(0.5 * std::log2(std::max(texels, 1e-9)))), 0,
                    static_cast<int>(levels_.size()) - 1);
}

Surroundings::Radiance Surroundings::at(const Vec3& world, int level) const {
  const Level& map = levels_[static_cast<size_t>(level)];
  const float scale = 1 / (std::abs(world.x) + std::abs(world.y) + std::abs(world.z));
  float u = world.x * scale, v = world.y * scale;
  if (world.z < 0) {
    const float folded = std::copysign(1 - std::abs(v), u);
    v = std::copysign(1 - std::abs(u), v);
    u = folded;
  }
  const auto side = static_cast<float>(map.side);
  const float x = std::clamp((0.5f * u + 0.5f) * side - 0.5f, 0.0f, side - 1);
  const float y = std::clamp((0.5f * v + 0.5f) * side - 0.5f, 0.0f, side - 1);
  const int left = std::min(static_cast<int>(x), map.side - 2), top = std::min(static_cast<int>(y), map.side - 2);
  const float right = x - static_cast<float>(left), below = y - static_cast<float>(top);
  const Radiance* row = &map.texels[static_cast<size_t>(top * map.side + left)];
  Radiance out;
  for (size_t i = 0; i < out.size(); ++i) {
    const float upper = row[0][i] + right * (row[1][i] - row[0][i]);
    const float lower = row[map.side][i] + right * (row[map.side + 1][i] - row[map.side][i]);
    out[i] = upper + below * (lower - upper);
  }
  return out;
}

}  // namespace velour

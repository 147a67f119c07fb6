#include "render/lighting.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sphere/random.h"

namespace velour {
namespace {

constexpr float kFloatBelowOne = 0x1.fffffep-1f;

}  // namespace

Lighting::Lighting(const Scene& scene, const Progress& progress)
    : environment_(scene.environment()), glow_(scene, progress) {
  // A scene of nothing or of one point still needs distant and near lights to compare.
  const float radius = std::max(scene.bounds().radius(), 1e-6f);
  for (const Light& light : scene.lights()) {
    const Lamp lamp(light, radius);
    if (!lamp.black()) (lamp.sharp() ? sharp_ : lamps_).push_back(lamp);
  }
  // Flux of radiance L from everywhere through a sphere of this radius.
  set_probabilities(4.0f * kPi * kPi * radius * radius * environment_.mean_luminance());
}

void Lighting::set_probabilities(float environment_power) {
  float total = environment_power;
  for (const Lamp& lamp : lamps_) total += lamp.power();
  if (glow_.power() > 0.0f) {
    const double others = static_cast<double>(total), glow = static_cast<double>(glow_.power());
    // A multiple of what random numbers are multiples of, so that the probability is exact.
    glow_begin_ = static_cast<float>(std::floor(others / (others + glow) * 0x1p24) * 0x1p-24);
    total += glow_.power();
  }
  environment_probability_ = total > 0.0f ? environment_power / total : 0.0f;
  for (const Lamp& lamp : lamps_) probability_.push_back(lamp.power() / total);

  float sharp_total = 0.0f, sum = 0.0f;
  for (const Lamp& lamp : sharp_) sharp_total += lamp.power();
  for (const Lamp& lamp : sharp_) sharp_cdf_.push_back(sum += lamp.power() / sharp_total);
}

/// Whether `u` chooses the environment; what is left of it then chooses the direction.
bool Lighting::choose_environment(Vec2& u) const {
  if (u.x >= environment_probability_) return false;
  u.x = std::min(u.x / environment_probability_, kFloatBelowOne);
  return true;
}

Vec3 Lighting::sample_lamp(const Vec3& position, const Vec2& u) const {
  if (lamps_.empty()) return Vec3(0.0f);
  float left = u.x - environment_probability_;
  size_t chosen = 0;
  while (chosen + 1 < lamps_.size() && left >= probability_[chosen]) left -= probability_[chosen++];
  return lamps_[chosen].sample(position, {std::min(left / probability_[chosen], kFloatBelowOne), u.y});
}

Vec3 Lighting::sample_glow(const Vec3& position, const Vec2& u, Hit* aim) const {
  // Among a hundred thousand triangles the 24 bits of a number are used up before it comes to a place in one of them.
  // What follows them is made of the bits of both.
  const uint64_t bits = (uint64_t{std::bit_cast<uint32_t>(u.x)} << 32) | std::bit_cast<uint32_t>(u.y);
  const double fine = static_cast<double>(mix64(bits) >> 11) * 0x1p-77;
  const double begin = static_cast<double>(glow_begin_);
  Vec3 direction;
  const Hit hit = glow_.sample(position, (static_cast<double>(u.x) + fine - begin) / (1.0 - begin), u.y, direction);
  if (aim != nullptr) *aim = hit;
  return direction;
}

void Lighting::sample(std::span<const Vec3> position, std::span<const Vec2> u, DirectionBatch& world,
                      std::span<Hit> aims) const {
  if (lamps_.empty() && glow_.empty()) return environment_.sample(u, world);
  Vec2 of_environment[DirectionBatch::kCapacity];
  int place[DirectionBatch::kCapacity];
  size_t count = 0;
  for (size_t i = 0; i < u.size(); ++i) {
    Vec2 left = u[i];
    Hit* aim = aims.empty() ? nullptr : &aims[i];
    if (aim != nullptr) aim->instance = kNoHit;
    if (u[i].x >= glow_begin_) {
      world.set(static_cast<int>(i), sample_glow(position[i], u[i], aim));
    } else if (choose_environment(left)) {
      place[count] = static_cast<int>(i);
      of_environment[count++] = left;
    } else {
      world.set(static_cast<int>(i), sample_lamp(position[i], u[i]));
    }
  }
  if (count > 0) {
    DirectionBatch sky;
    environment_.sample({of_environment, count}, sky);
    for (size_t k = 0; k < count; ++k) world.set(place[k], sky.get(static_cast<int>(k)));
  }
  world.count = static_cast<int>(u.size());
}

void Lighting::look_up(std::span<const Vec3> position, const DirectionBatch& world, RgbBatch& environment,
                       ScalarBatch& pdf, std::vector<LampHit>& hits) const {
  environment_.look_up(world, environment, pdf);
  if (lamps_.empty() && glow_.empty()) return;
  for (int i = 0; i < world.count; ++i) {
    float density = environment_probability_ * pdf.v[i];
    for (size_t k = 0; k < lamps_.size(); ++k) {
      const Lamp::Sight sight = lamps_[k].hit(position[static_cast<size_t>(i)], world.get(i));
      if (sight.pdf == 0.0f) continue;
      density += probability_[k] * sight.pdf;
      hits.push_back({i, &lamps_[k], sight.distance});
    }
    pdf.v[i] = density;
  }
}

size_t Lighting::choose_sharp(float u, float& probability) const {
  size_t chosen = 0;
  while (chosen + 1 < sharp_.size() && u >= sharp_cdf_[chosen]) ++chosen;
  probability = sharp_cdf_[chosen] - (chosen > 0 ? sharp_cdf_[chosen - 1] : 0.0f);
  return chosen;
}

}  // namespace velour

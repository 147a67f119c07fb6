#include "render/lights/lighting.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/sphere/random.h"

namespace velour {

namespace {

constexpr float kFloatBelowOne = 0x1.fffffep-1f;
constexpr double kMinShare = 0.3;
constexpr float kMinSun = 0.02f;  // minimum cosine, for planes that face away, where rounding decides
constexpr size_t kFewLamps = 4;   // up to this many, traversing the tree does not pay

/// Rounded to a multiple of 2^-24, as random numbers are, so that the probability is exact.
float exact(float probability) { return std::floor(probability * 0x1p24f) * 0x1p-24f; }

double sun_irradiance(const Lamp& sun, const LightPlace& place) {
  const float cosine = glm::dot(sun.axis(), place.normal);
  return static_cast<double>(sun.intensity() * std::max(place.both_sides ? std::abs(cosine) : cosine, kMinSun));
}

}  // namespace

Lighting::Lighting(const Scene& scene, const Progress& progress)
    : environment_(scene.environment()), sky_(environment_), emissive_(scene, progress) {
  std::vector<LightTree::Light> near, sharp_near;
  const auto light_of = [](const Lamp& lamp) {
    return LightTree::Light{lamp.bounds(), lamp.intensity(), lamp.cone_of_light()};
  };
  for (const Light& light : scene.lights()) {
    const Lamp lamp(light);
    if (lamp.black()) continue;
    if (lamp.sharp()) {
      if (!lamp.distant()) sharp_near.push_back(light_of(lamp));
      sharp_.push_back(lamp);
    } else if (lamp.distant()) {
      suns_.push_back(lamp);
    } else {
      near.push_back(light_of(lamp));
      lamps_.push_back(lamp);
    }
  }
  std::stable_partition(sharp_.begin(), sharp_.end(), [](const Lamp& lamp) { return lamp.distant(); });
  sharp_suns_ = sharp_.size() - sharp_near.size();
  near.insert(near.end(), emissive_.lights().begin(), emissive_.lights().end());
  near_ = LightTree(near, progress);
  sharp_near_ = LightTree(sharp_near, progress);
}

LightView Lighting::view(const LightPlace& place) const {
  double sky = 0;
  if (!environment_.black()) {
    sky = static_cast<double>(sky_.on(place.normal) + (place.both_sides ? sky_.on(-place.normal) : 0.0f));
  }
  return view_of_all(place, sky, suns_, near_);
}

LightView Lighting::sharp_view(const LightPlace& place) const {
  return view_of_all(place, 0, sharp().first(sharp_suns_), sharp_near_);
}

namespace {

constexpr double kMaxBrought = 1e30;  // keeps shares finite where radiances are near the largest float

}  // namespace

LightView Lighting::view_of_all(const LightPlace& place, double sky, std::span<const Lamp> suns,
                                const LightTree& near) {
  LightView view;
  view.place = place;
  for (const Lamp& sun : suns) view.suns_total += sun_irradiance(sun, place);
  if (!near.empty()) view.cut = near.cut(place);
  double brought[3] = {sky, view.suns_total, near.empty() ? 0 : view.cut.total()};
  for (double& b : brought) {
    if (!(b < kMaxBrought)) b = kMaxBrought;
  }
  const double total = brought[0] + brought[1] + brought[2];
  const auto kinds = static_cast<double>(std::ranges::count_if(brought, [](double b) { return b > 0; }));
  float share[3] = {}, left = 1.0f;
  int last = 0;
  for (int i = 0; i < 3; ++i) {
    if (!(brought[i] > 0)) continue;
    share[i] = exact(static_cast<float>(kMinShare / kinds + (1 - kMinShare) * brought[i] / total));
    left -= share[i];
    last = i;
  }
  share[last] += left;
  view.environment = share[0];
  view.suns = share[1];
  view.near = share[2];
  return view;
}

Lighting::Chosen Lighting::choose_sun(const LightView& view, std::span<const Lamp> suns, double x) {
  double left = x * view.suns_total, own = sun_irradiance(suns[0], view.place);
  size_t chosen = 0;
  while (chosen + 1 < suns.size() && left >= own) {
    left -= own;
    own = sun_irradiance(suns[++chosen], view.place);
  }
  return {chosen, own / view.suns_total, std::clamp(left / own, 0.0, kDoubleBelowOne)};
}

Vec3 Lighting::sample_sun(const LightView& view, double x, float y) const {
  const Chosen sun = choose_sun(view, suns_, x);
  return suns_[sun.lamp].sample(view.place.position, {std::min(static_cast<float>(sun.rest), kFloatBelowOne), y});
}

Vec3 Lighting::sample_near(const LightView& view, const Vec2& u, Hit* aim) const {
  // With a hundred thousand triangles, the choice uses up the 24 bits of a number before it gets to a point in one of
  // them. Further bits are hashed from both numbers.
  const uint64_t bits = (uint64_t{std::bit_cast<uint32_t>(u.x)} << 32) | std::bit_cast<uint32_t>(u.y);
  const double fine = static_cast<double>(mix64(bits) >> 11) * 0x1p-77;
  const auto begin = static_cast<double>(view.environment + view.suns);
  double x = (static_cast<double>(u.x) + fine - begin) / (1.0 - begin);
  const uint32_t light = near_.choose(view.cut, view.place, x);
  if (light < lamps_.size()) {
    return lamps_[light].sample(view.place.position, {std::min(static_cast<float>(x), kFloatBelowOne), u.y});
  }
  Vec3 direction;
  const auto of_emissive = light - static_cast<uint32_t>(lamps_.size());
  const Hit hit = emissive_.sample(of_emissive, view.place, x, u.y, direction);
  if (aim != nullptr) *aim = hit;
  return direction;
}

void Lighting::sample(std::span<const LightView> views, std::span<const uint8_t> view_of, std::span<const Vec2> u,
                      DirectionBatch& world, std::span<Hit> aims) const {
  if (suns_.empty() && near_.empty()) return environment_.sample(u, world);
  Vec2 of_environment[DirectionBatch::kCapacity];
  int place[DirectionBatch::kCapacity];
  size_t count = 0;
  for (size_t i = 0; i < u.size(); ++i) {
    const LightView& view = views[view_of[i]];
    Hit* aim = aims.empty() ? nullptr : &aims[i];
    if (aim != nullptr) aim->instance = kNoHit;
    if (u[i].x < view.environment) {
      place[count] = static_cast<int>(i);
      of_environment[count++] = {std::min(u[i].x / view.environment, kFloatBelowOne), u[i].y};
    } else if (u[i].x < view.environment + view.suns) {
      const double x = static_cast<double>(u[i].x - view.environment) / static_cast<double>(view.suns);
      world.set(static_cast<int>(i), sample_sun(view, x, u[i].y));
    } else {
      world.set(static_cast<int>(i), sample_near(view, u[i], aim));
    }
  }
  if (count > 0) {
    DirectionBatch sky;
    environment_.sample({of_environment, count}, sky);
    for (size_t k = 0; k < count; ++k) world.set(place[k], sky.get(static_cast<int>(k)));
  }
  world.count = static_cast<int>(u.size());
}

void Lighting::look_up(std::span<const LightView> views, std::span<const uint8_t> view_of, const DirectionBatch& world,
                       RgbBatch& environment, ScalarBatch& pdf, std::vector<LampHit>& hits) const {
  environment_.look_up(world, environment, pdf);
  if (suns_.empty() && near_.empty()) return;
  for (int i = 0; i < world.count; ++i) {
    const LightView& view = views[view_of[static_cast<size_t>(i)]];
    const Vec3 direction = world.get(i);
    float density = view.environment * pdf.v[i];
    const auto meet = [&](const Lamp& lamp, auto&& chosen) {
      const Lamp::Sight sight = lamp.hit(view.place.position, direction);
      if (sight.pdf == 0.0f) return;
      density += static_cast<float>(chosen()) * sight.pdf;
      hits.push_back({i, &lamp, sight.distance});
    };
    for (const Lamp& sun : suns_) {
      meet(sun, [&] { return static_cast<double>(view.suns) * sun_irradiance(sun, view.place) / view.suns_total; });
    }
    const auto meet_near = [&](uint32_t k) {
      meet(lamps_[k], [&] { return static_cast<double>(view.near) * near_.probability(view.cut, view.place, k); });
    };
    if (lamps_.size() <= kFewLamps) {
      for (uint32_t k = 0; k < lamps_.size(); ++k) meet_near(k);
    } else {
      near_.meet(view.place.position, direction, [&](uint32_t k) {
        if (k < lamps_.size()) meet_near(k);
      });
    }
    pdf.v[i] = density;
  }
}

float Lighting::emissive_pdf(const LightView& view, const Vec3& direction, const Hit& hit) const {
  uint32_t light;
  const double pdf = emissive_.pdf(view.place.position, direction, hit, light);
  if (pdf == 0) return 0.0f;
  const auto number = static_cast<uint32_t>(lamps_.size()) + light;
  const double all = pdf * static_cast<double>(view.near) * near_.probability(view.cut, view.place, number);
  return all < 1e30 ? static_cast<float>(all) : 0.0f;
}

size_t Lighting::choose_sharp(const LightView& view, float u, float& probability) const {
  if (u < view.suns) {
    const Chosen sun = choose_sun(view, sharp().first(sharp_suns_), static_cast<double>(u / view.suns));
    probability = view.suns * static_cast<float>(sun.probability);
    return sun.lamp;
  }
  double x = static_cast<double>((u - view.suns) / view.near);
  const uint32_t lamp = sharp_near_.choose(view.cut, view.place, x);
  probability = view.near * static_cast<float>(sharp_near_.probability(view.cut, view.place, lamp));
  return sharp_suns_ + lamp;
}

int find_sharp_light(const Lighting& lighting, const Vertex& vertex, PathNumbers& numbers,
                     std::span<SharpLight> found) {
  const auto lamps = lighting.sharp();
  const size_t room = std::min(found.size(), kMaxDeltaLights);
  const bool all = lamps.size() <= room;
  const size_t count = all ? lamps.size() : room;
  Vec2 u[kMaxDeltaLights];
  LightView view;
  if (!all) view = lighting.sharp_view(vertex.light_place());
  if (!all) numbers.points(Purpose::sharp, numbers.ray() * static_cast<uint32_t>(room), {u, room});
  int lit = 0;
  for (size_t i = 0; i < count; ++i) {
    float probability = 1.0f;
    const size_t chosen = all ? i : lighting.choose_sharp(view, u[i].x, probability);
    const Lamp::Irradiance light = lamps[chosen].irradiance(vertex.position);
    const Vec3 wl = vertex.frame.to_local(light.direction);
    if (!vertex.receives_light(wl, light.direction)) continue;
    if (lamps[chosen].is_hidden(vertex.kind_along(light.direction))) continue;
    const float share = all ? 1.0f : 1.0f / (static_cast<float>(room) * probability);
    found[static_cast<size_t>(lit++)] = {&lamps[chosen], light.distance, wl, light.direction,
                                         share * light.perpendicular};
  }
  return lit;
}

}  // namespace velour

#include "render/direct_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/lattice.h"

namespace velour {
namespace {

bool zero(const Rgb& c) { return c.r == 0.0f && c.g == 0.0f && c.b == 0.0f; }
bool finite(const Rgb& c) { return std::isfinite(c.r + c.g + c.b); }

}  // namespace

void DirectLight::draw_from_surface(const Vertex& vertex, int count, RandomStream& random) {
  if (count == 0) return;
  const Vec2 shift = random.next2();
  for (int i = 0; i < count; ++i) {
    const Vec3 wl = sample_surface(sampling_, vertex, prepared_, lattice_point(i, count, shift));
    local_.push(wl);
    world_.push(vertex.frame.to_world(wl));
  }
}

void DirectLight::draw_from_lights(const Vertex& vertex, int count, RandomStream& random) {
  if (count == 0) return;
  const Vec2 shift = random.next2();
  Vec2 u[DirectionBatch::kCapacity];
  for (int i = 0; i < count; ++i) u[i] = lattice_point(i, count, shift);
  lighting_.sample(vertex.position, {u, static_cast<size_t>(count)}, towards_light_);
  for (int i = 0; i < count; ++i) {
    Vec3 wl_world = towards_light_.get(i);
    if (wl_world == Vec3(0.0f)) wl_world = -vertex.frame.z;  // stands for no light: below the horizon
    world_.push(wl_world);
    local_.push(vertex.frame.to_local(wl_world));
  }
}

void DirectLight::draw(const Vertex& vertex, int directions, RandomStream& random) {
  local_.count = world_.count = 0;
  int from_lights = strategy_ == Strategy::light ? directions : 0;
  if (strategy_ == Strategy::mis) {
    from_lights = directions / 2;
    if (directions % 2 != 0 && random.next() < 0.5f) ++from_lights;
  }
  draw_from_surface(vertex, directions - from_lights, random);
  draw_from_lights(vertex, from_lights, random);
  world_.pad();
}

void DirectLight::add_sharp(const Vertex& vertex, RandomStream& random) {
  const auto lamps = lighting_.sharp();
  sharp_count_ = static_cast<int>(std::min<size_t>(lamps.size(), kSharpLamps));
  const bool all = lamps.size() <= kSharpLamps;
  for (int i = 0; i < sharp_count_; ++i) {
    float probability = 1.0f;
    const size_t chosen = all ? static_cast<size_t>(i) : lighting_.choose_sharp(random.next(), probability);
    const Lamp::Irradiance light = lamps[chosen].irradiance(vertex.position);
    const float share = all ? 1.0f : 1.0f / (kSharpLamps * probability);
    sharp_[i] = {&lamps[chosen], light.distance, share * light.perpendicular};
    local_.push(vertex.frame.to_local(light.direction));
  }
}

void DirectLight::evaluate(const Vertex& vertex, int directions) {
  local_.pad();
  vertex.surface->material->eval(prepared_, local_, f_, material_pdf_);
  if (directions == 0) return;
  lamp_hits_.clear();
  lighting_.look_up(vertex.position, world_, environment_, light_pdf_, lamp_hits_);
  if (strategy_ != Strategy::light) {
    const int all = local_.count;
    local_.count = directions;
    surface_pdf(sampling_, vertex, local_, material_pdf_, surface_pdf_);
    local_.count = all;
  }
  for (int i = 0; i < directions; ++i) {
    float density = strategy_ == Strategy::light ? light_pdf_.v[i] : surface_pdf_.v[i];
    if (strategy_ == Strategy::mis) density = 0.5f * (density + light_pdf_.v[i]);
    weight_[i] =
        density > 0.0f || std::isnan(density) ? local_.z[i] / (static_cast<float>(directions) * density) : 0.0f;
  }
}

Rgb DirectLight::reflectance(const Vertex& vertex, int direction) const {
  const Rgb f = f_.get(direction);
  return working_space_ && vertex.surface->rec709_colors ? *working_space_ * f : f;
}

void DirectLight::queue(const Vertex& vertex, const Receiver& receiver, int direction, Rgb light, float far,
                        bool casts_shadow, ShadowQueue& shadows, std::vector<CameraSample>& samples) {
  light *= receiver.throughput * reflectance(vertex, direction);
  if (zero(light)) return;
  if (!finite(light)) {
    ++nan_samples_;
    return;
  }
  if (!casts_shadow) {
    samples[receiver.sample].radiance += light;
    return;
  }
  shadows.add(vertex.ray(vertex.frame.to_world(local_.get(direction)), far), light, receiver.sample);
}

void DirectLight::gather(const Vertex& vertex, int directions, RandomStream& random, const Receiver& receiver,
                         ShadowQueue& shadows, std::vector<CameraSample>& samples) {
  if (!lighting_.has_extended()) directions = 0;
  draw(vertex, directions, random);
  add_sharp(vertex, random);
  if (local_.count == 0) return;
  evaluate(vertex, directions);

  const Vec3 up = vertex.frame.to_local(vertex.geometric_normal);
  // Above both the shading horizon and the surface itself.
  const auto lit = [&](int i) { return local_.z[i] > 0.0f && glm::dot(local_.get(i), up) > 0.0f; };
  for (int i = 0; i < directions; ++i) {
    if (weight_[i] == 0.0f || !lit(i)) continue;
    queue(vertex, receiver, i, weight_[i] * environment_.get(i), std::numeric_limits<float>::infinity(), true, shadows,
          samples);
  }
  for (const LampHit& hit : lamp_hits_) {
    if (directions == 0 || weight_[hit.direction] == 0.0f || !lit(hit.direction)) continue;
    queue(vertex, receiver, hit.direction, weight_[hit.direction] * hit.lamp->radiance(), hit.distance,
          hit.lamp->casts_shadow(), shadows, samples);
  }
  for (int k = 0; k < sharp_count_; ++k) {
    const int i = directions + k;
    if (!lit(i)) continue;
    queue(vertex, receiver, i, local_.z[i] * sharp_[k].irradiance, sharp_[k].distance, sharp_[k].lamp->casts_shadow(),
          shadows, samples);
  }
}

std::optional<DirectLight::Continuation> DirectLight::extend(const Vertex& vertex, RandomStream& random,
                                                             const Rgb& throughput) {
  local_.count = 0;
  local_.push(sample_surface(sampling_, vertex, prepared_, random.next2()));
  local_.pad();
  const Vec3 wl_world = vertex.frame.to_world(local_.get(0));
  if (!(local_.z[0] > 0.0f) || !(glm::dot(wl_world, vertex.geometric_normal) > 0.0f)) return std::nullopt;
  vertex.surface->material->eval(prepared_, local_, f_, material_pdf_);
  surface_pdf(sampling_, vertex, local_, material_pdf_, surface_pdf_);
  const Rgb f = reflectance(vertex, 0);
  if (zero(f)) return std::nullopt;
  const Rgb onward = throughput * f * (local_.z[0] / surface_pdf_.v[0]);
  if (!finite(onward)) {
    ++nan_samples_;
    return std::nullopt;
  }
  return Continuation{vertex.ray(wl_world, std::numeric_limits<float>::infinity()), onward};
}

}  // namespace velour

#include "render/direct_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/lattice.h"

namespace velour {
namespace {

bool zero(const Rgb& c) { return c.r == 0.0f && c.g == 0.0f && c.b == 0.0f; }

/// Of `product`, where the sky gives all light: lamps take from it.
constexpr float kProductShare = 0.5f;

bool finite(const Rgb& c) { return std::isfinite(c.r + c.g + c.b); }

}  // namespace

/// A direction that brings nothing costs nothing further: n counts it, the batch does not hold it.
void DirectLight::keep_if_lit(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world) {
  if (!(wl.z > 0.0f) || !(glm::dot(wl_world, vertex.geometric_normal) > 0.0f)) return;
  local_.push(wl);
  world_.push(wl_world);
}

void DirectLight::draw_from_surface(const Vertex& vertex, int count, RandomStream& random) {
  if (count == 0) return;
  const Vec2 shift = random.next2();
  for (int i = 0; i < count; ++i) {
    const Vec3 wl = sample_surface(sampling_, vertex, prepared_, lattice_point(i, count, shift));
    keep_if_lit(vertex, wl, vertex.frame.to_world(wl));
  }
}

void DirectLight::draw_from_lights(const Vertex& vertex, int count, RandomStream& random) {
  if (count == 0) return;
  const Vec2 shift = random.next2();
  Vec2 u[DirectionBatch::kCapacity];
  for (int i = 0; i < count; ++i) u[i] = lattice_point(i, count, shift);
  lighting_.sample(vertex.position, {u, static_cast<size_t>(count)}, towards_light_);
  for (int i = 0; i < count; ++i) {
    const Vec3 wl_world = towards_light_.get(i);  // zero for a lamp's dark side: then not above the horizon
    keep_if_lit(vertex, vertex.frame.to_local(wl_world), wl_world);
  }
}

void DirectLight::draw_from_product(const Vertex& vertex, int count, RandomStream& random) {
  if (count == 0) return;
  const Vec2 shift = random.next2();
  for (int i = 0; i < count; ++i) {
    const Vec3 wl_world = sample_mixture(product_, lattice_point(i, count, shift));
    keep_if_lit(vertex, vertex.frame.to_local(wl_world), wl_world);
  }
}

DirectLight::Shares DirectLight::shares(const Vertex& vertex) {
  if (strategy_ == Strategy::mis) return {0.5f, 0.5f, 0};
  if (strategy_ == Strategy::light) return {0, 1, 0};
  if (strategy_ != Strategy::product) return {1, 0, 0};
  const LobeMixture* lobes = vertex.surface->material->gaussian_lobes(prepared_);
  const bool proposed = lobes != nullptr && sky_ != nullptr && sky_->propose(*lobes, vertex.frame, products_, product_);
  const float product = proposed ? kProductShare * lighting_.environment_share() : 0;
  return {0.5f * (1 - product), 0.5f * (1 - product), product};
}

void DirectLight::draw(const Vertex& vertex, int directions, RandomStream& random) {
  local_.count = world_.count = 0;
  if (directions == 0) return;
  shares_ = shares(vertex);
  const auto n = static_cast<float>(directions);
  // Two cuts of the n directions, moved by one random number: each part is its share times n, rounded up or down.
  const float move = shares_.surface * n == std::floor(shares_.surface * n) && shares_.product == 0 ? 0 : random.next();
  const int first = static_cast<int>(shares_.product * n + move);
  const int second = std::min(static_cast<int>((shares_.product + shares_.surface) * n + move), directions);
  draw_from_product(vertex, first, random);
  draw_from_surface(vertex, second - first, random);
  draw_from_lights(vertex, directions - second, random);
  world_.pad();
}

void DirectLight::draw_sharp(const Vertex& vertex, RandomStream& random) {
  const auto lamps = lighting_.sharp();
  const bool all = lamps.size() <= kSharpLamps;
  const int count = all ? static_cast<int>(lamps.size()) : kSharpLamps;
  sharp_count_ = 0;
  for (int i = 0; i < count; ++i) {
    float probability = 1.0f;
    const size_t chosen = all ? static_cast<size_t>(i) : lighting_.choose_sharp(random.next(), probability);
    const Lamp::Irradiance light = lamps[chosen].irradiance(vertex.position);
    const Vec3 wl = vertex.frame.to_local(light.direction);
    if (!(wl.z > 0.0f) || !(glm::dot(light.direction, vertex.geometric_normal) > 0.0f)) continue;
    const float share = all ? 1.0f : 1.0f / (kSharpLamps * probability);
    sharp_[sharp_count_++] = {&lamps[chosen], light.distance, share * light.perpendicular};
    local_.push(wl);
  }
}

/// Density of every drawn direction under the strategy, and from it what its light counts.
void DirectLight::weigh(const Vertex& vertex, int directions) {
  lamp_hits_.clear();
  if (world_.count == 0) return;
  lighting_.look_up(vertex.position, world_, environment_, light_pdf_, lamp_hits_);
  if (shares_.surface > 0) surface_pdf(sampling_, vertex, local_, material_pdf_, surface_pdf_);
  if (shares_.product > 0) eval_density(product_, world_, product_pdf_);
  for (int i = 0; i < world_.count; ++i) {
    float density = 0;
    if (shares_.surface > 0) density += shares_.surface * surface_pdf_.v[i];
    if (shares_.lights > 0) density += shares_.lights * light_pdf_.v[i];
    if (shares_.product > 0) density += shares_.product * product_pdf_.v[i];
    // A direction of density 0 was drawn by rounding alone. One that is not a number passes, to be counted.
    weight_[i] = density == 0.0f ? 0.0f : local_.z[i] / (static_cast<float>(directions) * density);
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
  draw(vertex, lighting_.has_extended() ? directions : 0, random);
  draw_sharp(vertex, random);
  if (local_.count == 0) return;
  local_.pad();
  vertex.surface->material->eval(prepared_, local_, f_, material_pdf_);
  weigh(vertex, directions);

  for (int i = 0; i < world_.count; ++i) {
    queue(vertex, receiver, i, weight_[i] * environment_.get(i), std::numeric_limits<float>::infinity(), true, shadows,
          samples);
  }
  for (const LampHit& hit : lamp_hits_) {
    queue(vertex, receiver, hit.direction, weight_[hit.direction] * hit.lamp->radiance(), hit.distance,
          hit.lamp->casts_shadow(), shadows, samples);
  }
  for (int k = 0; k < sharp_count_; ++k) {
    const int i = world_.count + k;
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

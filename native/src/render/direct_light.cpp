#include "render/direct_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace velour {
namespace {

/// Of `product`, where the sky gives all light: lamps take from it.
constexpr float kProductShare = 0.5f;

bool zero(const Rgb& c) { return c.r == 0.0f && c.g == 0.0f && c.b == 0.0f; }
bool finite(const Rgb& c) { return std::isfinite(c.r + c.g + c.b); }

}  // namespace

/// A direction that brings nothing costs nothing further: n counts it, the batch does not hold it.
void DirectLight::keep_if_lit(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world) {
  if (!(wl.z > 0.0f) || !(glm::dot(wl_world, vertex.geometric_normal) > 0.0f)) return;
  local_.push(wl);
  world_.push(wl_world);
}

void DirectLight::draw_from_product(const Vertex& vertex, PathNumbers::Run run, PathNumbers& numbers) {
  Vec2 u[DirectionBatch::kCapacity];
  numbers.points(Purpose::product, run.first, {u, static_cast<size_t>(run.count)});
  for (int i = 0; i < run.count; ++i) {
    const Vec3 wl_world = sample_mixture(product_, u[i]);
    keep_if_lit(vertex, vertex.frame.to_local(wl_world), wl_world);
  }
}

void DirectLight::draw_from_surface(const Vertex& vertex, PathNumbers::Run run, PathNumbers& numbers) {
  Vec2 u[DirectionBatch::kCapacity];
  numbers.points(Purpose::surface, run.first, {u, static_cast<size_t>(run.count)});
  for (int i = 0; i < run.count; ++i) {
    const Vec3 wl = sample_surface(sampling_, vertex, prepared_, u[i]);
    keep_if_lit(vertex, wl, vertex.frame.to_world(wl));
  }
}

void DirectLight::draw_from_lights(const Vertex& vertex, PathNumbers::Run run, PathNumbers& numbers) {
  if (run.count == 0) return;
  Vec2 u[DirectionBatch::kCapacity];
  const std::span<Vec2> points(u, static_cast<size_t>(run.count));
  numbers.points(Purpose::light, run.first, points);
  lighting_.sample(vertex.position, points, towards_light_);
  for (int i = 0; i < run.count; ++i) {
    const Vec3 wl_world = towards_light_.get(i);  // zero for a lamp's dark side: then not above the horizon
    keep_if_lit(vertex, vertex.frame.to_local(wl_world), wl_world);
  }
}

float DirectLight::product_share(const Vertex& vertex) {
  if (options_.strategy != Strategy::product || sky_ == nullptr) return 0.0f;
  const LobeMixture* lobes = vertex.surface->material->gaussian_lobes(prepared_);
  const bool proposed = lobes != nullptr && sky_->propose(*lobes, vertex.frame, products_, product_);
  return proposed ? kProductShare * lighting_.environment_share() : 0.0f;
}

void DirectLight::draw(const Vertex& vertex, Draws draws, PathNumbers& numbers) {
  combination_ = combination(options_, product_share(vertex));
  const float product = combination_.of(Drawer::product), lights = combination_.of(Drawer::lights);
  const auto [rest, from_product] = numbers.deal(numbers.all(draws.count, draws.full), product, Purpose::product_side);
  const auto [from_surface, from_lights] = numbers.deal(rest, lights / (1.0f - product), Purpose::side);
  draw_from_product(vertex, from_product, numbers);
  end_[0] = world_.count;
  draw_from_surface(vertex, from_surface, numbers);
  end_[1] = world_.count;
  draw_from_lights(vertex, from_lights, numbers);
  world_.pad();
}

void DirectLight::draw_sharp(const Vertex& vertex, PathNumbers& numbers) {
  const auto lamps = lighting_.sharp();
  const bool all = lamps.size() <= kSharpLamps;
  const int count = all ? static_cast<int>(lamps.size()) : kSharpLamps;
  sharp_count_ = 0;
  Vec2 u[kSharpLamps];
  if (!all) numbers.points(Purpose::sharp, numbers.ray() * kSharpLamps, u);
  for (int i = 0; i < count; ++i) {
    float probability = 1.0f;
    const size_t chosen = all ? static_cast<size_t>(i) : lighting_.choose_sharp(u[i].x, probability);
    const Lamp::Irradiance light = lamps[chosen].irradiance(vertex.position);
    const Vec3 wl = vertex.frame.to_local(light.direction);
    if (!(wl.z > 0.0f) || !(glm::dot(light.direction, vertex.geometric_normal) > 0.0f)) continue;
    const float share = all ? 1.0f : 1.0f / (kSharpLamps * probability);
    sharp_[sharp_count_++] = {&lamps[chosen], light.distance, share * light.perpendicular};
    local_.push(wl);
  }
}

/// Density of every drawn direction under the combination, and from it what its light counts.
void DirectLight::weigh(const Vertex& vertex, int directions) {
  lamp_hits_.clear();
  if (world_.count == 0) return;
  const bool has_product = combination_.of(Drawer::product) > 0.0f;
  lighting_.look_up(vertex.position, world_, environment_, light_pdf_, lamp_hits_);
  surface_pdf(sampling_, vertex, prepared_, local_, material_pdf_, surface_pdf_);
  if (has_product) eval_density(product_, world_, product_pdf_);
  for (int i = 0; i < world_.count; ++i) {
    const Drawer own = i < end_[0] ? Drawer::product : (i < end_[1] ? Drawer::surface : Drawer::lights);
    const float pdf[3] = {has_product ? product_pdf_.v[i] : 0.0f, surface_pdf_.v[i], light_pdf_.v[i]};
    const float density = combination_.effective(pdf, own);
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

void DirectLight::gather(const Vertex& vertex, Draws draws, PathNumbers& numbers, const Receiver& receiver,
                         ShadowQueue& shadows, std::vector<CameraSample>& samples) {
  local_.count = world_.count = 0;
  if (lighting_.has_extended()) draw(vertex, draws, numbers);
  draw_sharp(vertex, numbers);
  if (local_.count == 0) return;
  local_.pad();
  vertex.surface->material->eval(prepared_, local_, f_, material_pdf_);
  weigh(vertex, draws.count);

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

std::optional<DirectLight::Continuation> DirectLight::extend(const Vertex& vertex, PathNumbers& numbers,
                                                             const Rgb& throughput) {
  local_.count = 0;
  local_.push(sample_surface(sampling_, vertex, prepared_, numbers.point(Purpose::onward)));
  local_.pad();
  const Vec3 wl_world = vertex.frame.to_world(local_.get(0));
  if (!(local_.z[0] > 0.0f) || !(glm::dot(wl_world, vertex.geometric_normal) > 0.0f)) return std::nullopt;
  vertex.surface->material->eval(prepared_, local_, f_, material_pdf_);
  surface_pdf(sampling_, vertex, prepared_, local_, material_pdf_, surface_pdf_);
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

#include "usage/observe/hit_light.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/shadow_queue.h"
#include "usage/observe/scene_observer.h"

namespace velour {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

HitLight HitLightEstimator::estimate(const Vertex& vertex, int bounces, uint64_t key) {
  result_ = {};
  concentrations_.clear();
  irradiance_ = 0;
  arena_.reset();
  brdf_ = vertex.surface->material->prepare(vertex.wv, vertex.site, {}, arena_);
  if (lighting_.has_extended()) view_ = lighting_.view(vertex.light_place());
  estimate_half(vertex, bounces, key, 0);
  result_.middle = static_cast<uint32_t>(result_.wl.size());
  estimate_half(vertex, bounces, key, 1);
  result_.light_density = light_density();
  return std::move(result_);
}

void HitLightEstimator::estimate_half(const Vertex& vertex, int bounces, uint64_t key, int half) {
  PathNumbers numbers(options_[half], key, 0);
  const Counts n = counts(bounces);
  if (n.all() > 0) {
    draw(vertex, n, numbers);
    weigh(vertex, n);
    trace(vertex);
    add_lights(vertex);
    add_emissive(vertex, n);
    if (bounces > 0) add_surfaces(vertex.cone, bounces, key, half);
    for (int i = 0; i < world_.count; ++i) add_term(local_.get(i), weight_[i] * radiance_[i] + emissive_[i]);
  }
  add_sharp(vertex, numbers);
}

HitLightEstimator::Counts HitLightEstimator::counts(int bounces) const {
  if (lighting_.has_extended()) return {kObservedDirections / 2, kObservedDirections / 2};
  return {0, bounces > 0 ? kObservedDirections : 0};
}

void HitLightEstimator::draw(const Vertex& vertex, Counts counts, PathNumbers& numbers) {
  local_.count = world_.count = 0;
  Vec2 u[kObservedDirections];
  Hit aims[kObservedDirections];
  DirectionBatch drawn;
  if (counts.lights > 0) {
    const std::span<Vec2> points(u, static_cast<size_t>(counts.lights));
    numbers.points(Purpose::light, 0, points);
    lighting_.sample({&view_, 1}, {view_of_, points.size()}, points, drawn, {aims, points.size()});
    for (int i = 0; i < drawn.count; ++i) {
      keep_if_received(vertex, vertex.frame.to_local(drawn.get(i)), drawn.get(i), Technique::lights, aims[i]);
    }
  }
  const std::span<Vec2> points(u, static_cast<size_t>(counts.surface));
  numbers.points(Purpose::surface, 0, points);
  brdf_->sample(points, drawn);
  for (int i = 0; i < drawn.count; ++i) {
    keep_if_received(vertex, drawn.get(i), vertex.frame.to_world(drawn.get(i)), Technique::surface, {});
  }
}

void HitLightEstimator::keep_if_received(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world,
                                         Technique technique, const Hit& aim) {
  if (!vertex.receives_light(wl, wl_world)) return;
  technique_[local_.count] = technique;
  aims_[local_.count] = aim;
  local_.push(wl);
  world_.push(wl_world);
}

/// Looks up the directions and weights them by the density of the balance heuristic.
void HitLightEstimator::weigh(const Vertex& vertex, Counts counts) {
  local_.pad();
  world_.pad();
  lamp_hits_.clear();
  std::fill_n(environment_.r, world_.count, 0.0f);
  std::fill_n(environment_.g, world_.count, 0.0f);
  std::fill_n(environment_.b, world_.count, 0.0f);
  std::fill_n(light_pdf_.v, world_.count, 0.0f);
  if (lighting_.has_extended() && world_.count > 0) {
    lighting_.look_up({&view_, 1}, {view_of_, static_cast<size_t>(world_.count)}, world_, environment_, light_pdf_,
                      lamp_hits_);
  }
  brdf_->eval(local_, f_, material_pdf_);
  for (int i = 0; i < world_.count; ++i) {
    const float density =
        static_cast<float>(counts.lights) * light_pdf_.v[i] + static_cast<float>(counts.surface) * material_pdf_.v[i];
    weight_[i] = density > 0.0f && aims_[i].instance == kNoHit ? std::abs(local_.z[i]) / density : 0.0f;
  }
}

void HitLightEstimator::trace(const Vertex& vertex) {
  const auto count = static_cast<size_t>(world_.count);
  for (size_t i = 0; i < count; ++i) rays_[i] = vertex.shadow_ray(world_.get(static_cast<int>(i)), kInfinity);
  visible_.intersect({rays_, count}, hits_, hidden::kFromBounces, passed_);
}

/// Radiance of unoccluded environment and lights.
void HitLightEstimator::add_lights(const Vertex& vertex) {
  for (int i = 0; i < world_.count; ++i) {
    radiance_[i] = hits_[i].instance == kNoHit ? passed_[i] * environment_.get(i) : Rgb(0.0f);
  }
  for (const LampHit& lamp : lamp_hits_) {
    radiance_[lamp.direction] += passed_from(vertex, lamp) * lamp.lamp->radiance(world_.get(lamp.direction));
  }
  for (int i = 0; i < world_.count; ++i) note_density(light_pdf_.v[i], weight_[i] * radiance_[i]);
}

Rgb HitLightEstimator::passed_from(const Vertex& vertex, const LampHit& lamp) const {
  if (!lamp.lamp->casts_shadow()) return Rgb(1.0f);
  const Hit& hit = hits_[lamp.direction];
  if (!visible_.dims()) return Rgb(hit.instance != kNoHit && hit.distance < lamp.distance ? 0.0f : 1.0f);
  // The ray of the direction passed surfaces at random, and its hit may lie behind the light.
  Rgb passed;
  return visible_.occluded(vertex.shadow_ray(world_.get(lamp.direction), lamp.distance), &passed) ? Rgb(0.0f) : passed;
}

/// As in LightTerms, light-sampled directions carry the light of a surface only if they were aimed at it.
void HitLightEstimator::add_emissive(const Vertex& vertex, Counts counts) {
  for (int i = 0; i < world_.count; ++i) {
    emissive_[i] = Rgb(0.0f);
    const Hit& hit = hits_[i];
    if (hit.instance == kNoHit || !lighting_.emissive().holds(hit)) continue;
    if (technique_[i] == Technique::lights && !same_crossing(hit, aims_[i])) continue;
    const float pdf = lighting_.emissive_pdf(view_, world_.get(i), hit);
    const float density =
        static_cast<float>(counts.lights) * pdf + static_cast<float>(counts.surface) * material_pdf_.v[i];
    if (!(density > 0.0f)) continue;
    const Vertex surface = Vertex::seen(scene_, rays_[i], hit, vertex.cone, nullptr);
    emissive_[i] = std::abs(local_.z[i]) / density * passed_[i] * surface.emission();
    note_density(pdf, emissive_[i]);
  }
}

void HitLightEstimator::add_surfaces(const RayCone& cone, int bounces, uint64_t key, int half) {
  IndirectLight& indirect = indirect_[half];
  int direction[DirectionBatch::kCapacity];
  indirect.clear();
  for (int i = 0; i < world_.count; ++i) {
    if (hits_[i].instance == kNoHit || weight_[i] == 0.0f) continue;
    PathNumbers numbers(options_[half], key, static_cast<uint32_t>(i));
    numbers.next_vertex();
    direction[indirect.samples().size()] = i;
    indirect.add(rays_[i], cone, hits_[i], numbers);
  }
  indirect.resolve(bounces);
  for (size_t k = 0; k < indirect.samples().size(); ++k) {
    radiance_[direction[k]] += passed_[direction[k]] * indirect.samples()[k].radiance;
  }
}

void HitLightEstimator::add_sharp(const Vertex& vertex, PathNumbers& numbers) {
  SharpLight sharp[kMaxDeltaLights];
  const int count = find_sharp_light(lighting_, vertex, numbers, sharp);
  for (int i = 0; i < count; ++i) {
    const SharpLight& s = sharp[i];
    Rgb passed(1.0f);
    if (s.lamp->casts_shadow() && visible_.occluded(vertex.shadow_ray(s.wl_world, s.distance), &passed)) continue;
    const Rgb light = std::abs(s.wl.z) * passed * s.irradiance;
    note_density(kInfinity, light);
    add_term(s.wl, light);
  }
}

/// Drops terms that are not finite, as the renderer does.
void HitLightEstimator::add_term(const Vec3& wl, const Rgb& light) {
  if (light == Rgb(0.0f) || !std::isfinite(light.r + light.g + light.b)) return;
  result_.wl.push_back(wl);
  result_.light.push_back(light);
  irradiance_ += static_cast<double>(luminance(light));
}

void HitLightEstimator::note_density(float density, const Rgb& light) {
  const double brought = static_cast<double>(luminance(light));
  if (brought > 0.0 && std::isfinite(brought)) concentrations_.push_back({density, brought});
}

float HitLightEstimator::light_density() {
  std::ranges::sort(concentrations_, std::ranges::greater(), &Concentration::density);
  double brought = 0;
  for (const Concentration& c : concentrations_) {
    brought += c.luminance;
    if (brought >= kNoticeableLight * irradiance_) return c.density;
  }
  return 0.0f;
}

}  // namespace velour

#include "usage/observe/hit_light.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "render/shadow_queue.h"
#include "usage/observe/scene_observer.h"

namespace velour {

HitLight HitLightRecorder::record(const Vertex& vertex, int bounces, uint64_t key) {
  result_ = {};
  concentrations_.clear();
  irradiance_ = 0;
  record_half(vertex, bounces, key, 0);
  result_.middle = static_cast<uint32_t>(result_.wl.size());
  record_half(vertex, bounces, key, 1);
  result_.light_density = light_density();
  return std::move(result_);
}

void HitLightRecorder::record_half(const Vertex& vertex, int bounces, uint64_t key, int half) {
  PathNumbers numbers(options_[half], key, 0);
  direct_[half].gather_incident(vertex, numbers, kObservedDirections, bounces > 0, incident_);
  std::ranges::fill(light_, Rgb(0.0f));
  add_unoccluded_terms();
  if (bounces > 0) add_surfaces(vertex.cone, bounces, key, half);
  for (size_t i = 0; i < std::size(light_); ++i) add_term(wl_[i], light_[i]);
  add_sharp(vertex, numbers);
}

void HitLightRecorder::add_unoccluded_terms() {
  rays_.clear();
  for (const IncidentLight::Term& term : incident_.terms) rays_.push_back(term.shadow_ray);
  blocked_.resize(rays_.size());
  passed_.assign(rays_.size(), Rgb(1.0f));
  visible_.occluded(rays_, blocked_.data(), visible_.dims() ? passed_.data() : nullptr);
  for (size_t i = 0; i < rays_.size(); ++i) {
    const IncidentLight::Term& term = incident_.terms[i];
    if (term.casts_shadow && blocked_[i]) continue;
    const Rgb light = term.casts_shadow ? passed_[i] * term.light : term.light;
    add(term.direction, term.wl, light);
    note_density(term.density, light);
  }
}

void HitLightRecorder::add_surfaces(const RayCone& cone, int bounces, uint64_t key, int half) {
  rays_.clear();
  for (const IncidentLight::Path& path : incident_.paths) rays_.push_back(path.along.ray);
  hits_.resize(rays_.size());
  passed_.assign(rays_.size(), Rgb(1.0f));
  visible_.intersect(rays_, hits_.data(), hidden::kFromBounces, visible_.dims() ? passed_.data() : nullptr);
  IndirectLight& indirect = indirect_[half];
  indirect.clear();
  met_.clear();
  for (size_t i = 0; i < rays_.size(); ++i) {
    if (hits_[i].instance == kNoHit) continue;
    PathNumbers numbers(options_[half], key, static_cast<uint32_t>(i));
    numbers.next_vertex();
    met_.push_back(i);
    indirect.add(rays_[i], cone, hits_[i], numbers);
  }
  indirect.resolve(bounces);
  for (size_t k = 0; k < met_.size(); ++k) {
    const auto& [direction, along] = incident_.paths[met_[k]];
    add(direction, along.wl, along.throughput * passed_[met_[k]] * indirect.samples()[k].radiance);
  }
}

void HitLightRecorder::add_sharp(const Vertex& vertex, PathNumbers& numbers) {
  SharpLight sharp[kMaxDeltaLights];
  const int count = find_sharp_light(lighting_, vertex, numbers, sharp);
  for (int i = 0; i < count; ++i) {
    const SharpLight& s = sharp[i];
    Rgb passed(1.0f);
    if (s.lamp->casts_shadow() && visible_.occluded(vertex.shadow_ray(s.wl_world, s.distance), &passed)) continue;
    const Rgb light = std::abs(s.wl.z) * passed * s.irradiance;
    note_density(std::numeric_limits<float>::infinity(), light);
    add_term(s.wl, light);
  }
}

void HitLightRecorder::add(uint32_t direction, const Vec3& wl, const Rgb& light) {
  if (!std::isfinite(light.r + light.g + light.b)) return;
  wl_[direction] = wl;
  light_[direction] += light;
}

void HitLightRecorder::add_term(const Vec3& wl, const Rgb& light) {
  if (light == Rgb(0.0f) || !std::isfinite(light.r + light.g + light.b)) return;
  result_.wl.push_back(wl);
  result_.light.push_back(light);
  irradiance_ += static_cast<double>(luminance(light));
}

void HitLightRecorder::note_density(float density, const Rgb& light) {
  const auto brought = static_cast<double>(luminance(light));
  if (brought > 0.0 && std::isfinite(brought)) concentrations_.push_back({density, brought});
}

float HitLightRecorder::light_density() {
  std::ranges::sort(concentrations_, std::ranges::greater(), &Concentration::density);
  double brought = 0;
  for (const Concentration& c : concentrations_) {
    brought += c.luminance;
    if (brought >= kNoticeableLight * irradiance_) return c.density;
  }
  return 0.0f;
}

}  // namespace velour

#include "usage/observe/hit_light.h"

#include <algorithm>
#include <cmath>
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
  add_unoccluded_terms();
  if (bounces > 0) add_surfaces(vertex.cone, bounces, key, half);
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
    if (!term.casts_shadow) add_term(term.wl, term.light, term.density);
    if (term.casts_shadow && !blocked_[i]) add_term(term.wl, passed_[i] * term.light, term.density);
  }
}

void HitLightRecorder::add_surfaces(const RayCone& cone, int bounces, uint64_t key, int half) {
  const std::vector<Continuation>& continuations = incident_.continuations;
  rays_.clear();
  for (const Continuation& c : continuations) rays_.push_back(c.ray);
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
    const Continuation& c = continuations[met_[k]];
    add_term(c.wl, c.throughput * passed_[met_[k]] * indirect.samples()[k].radiance, 0.0f);
  }
}

void HitLightRecorder::add_sharp(const Vertex& vertex, PathNumbers& numbers) {
  SharpLight sharp[kMaxDeltaLights];
  const int count = find_sharp_light(lighting_, vertex, numbers, sharp);
  for (int i = 0; i < count; ++i) {
    const SharpLight& s = sharp[i];
    Rgb passed(1.0f);
    if (s.lamp->casts_shadow() && visible_.occluded(vertex.shadow_ray(s.wl_world, s.distance), &passed)) continue;
    add_term(s.wl, std::abs(s.wl.z) * passed * s.irradiance, std::numeric_limits<float>::infinity());
  }
}

/// Drops terms that are not finite, as the renderer does.
void HitLightRecorder::add_term(const Vec3& wl, const Rgb& light, float density) {
  if (light == Rgb(0.0f) || !std::isfinite(light.r + light.g + light.b)) return;
  result_.wl.push_back(wl);
  result_.light.push_back(light);
  const auto brought = static_cast<double>(luminance(light));
  irradiance_ += brought;
  if (density > 0.0f && brought > 0.0) concentrations_.push_back({density, brought});
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

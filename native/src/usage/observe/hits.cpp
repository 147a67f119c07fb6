#include "usage/observe/hits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>

#include "material/material.h"
#include "material/normal_map.h"
#include "material/surface_site.h"
#include "render/path/shadow_queue.h"
#include "usage/observation.h"
#include "usage/observe/scene_observer.h"

namespace velour {

namespace {

size_t view_bin(const Vec3& wv) {
  const double bin = theta_of(wv) * (SceneDomain::kViewBins / (0.5 * kPiD));
  return static_cast<size_t>(std::min(bin, SceneDomain::kViewBins - 1.0));
}

}  // namespace

void ViewTracer::follow(uint64_t first, uint64_t end, SeenWeights& seen) {
  start(first, end);
  for (int depth = 0; depth <= options_.bounces && !paths_.empty(); ++depth) {
    hits_.resize(rays_.size());
    passed_.resize(visible_.dims() ? rays_.size() : 0);
    const RayKinds kinds = depth == 0 ? RayKinds{hidden::kFromCamera} : RayKinds{.each = kinds_};
    visible_.intersect(rays_, hits_.data(), kinds, visible_.dims() ? passed_.data() : nullptr);
    kinds_.clear();
    for (size_t i = 0; i < passed_.size(); ++i) paths_[i].throughput *= passed_[i];
    next_.clear();
    next_rays_.clear();
    for (size_t i = 0; i < paths_.size(); ++i) meet(i, depth, seen);
    paths_.swap(next_);
    rays_.swap(next_rays_);
  }
}

void ViewTracer::start(uint64_t first, uint64_t end) {
  paths_.clear();
  rays_.clear();
  const Vec2 size(static_cast<float>(grid_.width), static_cast<float>(grid_.height));
  for (uint64_t cell = first; cell < end; ++cell) {
    paths_.push_back({PathNumbers(options_, cell, 0), Rgb(1.0f), cell, {}});
    const Vec2 corner(static_cast<float>(cell % grid_.width), static_cast<float>(cell / grid_.width));
    const Camera& camera = scene_.camera();
    const Vec2 place = (corner + paths_.back().numbers.point(Purpose::camera)) / size;
    const bool has_lens = camera.aperture.radius > 0.0f;
    const Vec2 lens = has_lens ? camera.aperture.sample(paths_.back().numbers.point(Purpose::lens)) : Vec2(0.0f);
    rays_.push_back(camera.ray(place, lens));
    paths_.back().cone = pixel_.cone(rays_.back().direction);
  }
}

void ViewTracer::meet(size_t path, int depth, SeenWeights& seen) {
  if (hits_[path].instance == kNoHit) return;
  if (depth == 0 && scene_.is_holdout(hits_[path])) return;
  const Vertex vertex =
      Vertex::seen(scene_, rays_[path], hits_[path], paths_[path].cone, depth == 0 ? &pixel_ : nullptr);
  if (vertex.surface == &material_) see(vertex, paths_[path], depth, seen);
  if (depth < options_.bounces) go_on(vertex, paths_[path]);
}

void ViewTracer::see(const Vertex& vertex, const Path& path, int depth, SeenWeights& seen) {
  const double weight = static_cast<double>(luminance(path.throughput));
  if (!(weight > 0.0)) return;
  seen.view[view_bin(above_horizon(vertex.wv))] += weight;
  if (material_.material->varies()) see_surface(vertex, weight, seen.surface);
  // The position is part of the stream, so that frames with the same seed sample independently.
  auto place = static_cast<uint64_t>(depth);
  for (int i = 0; i < 3; ++i) place = mix64(place + std::bit_cast<uint32_t>(vertex.position[i]));
  draws_.add({vertex, options_.bounces - depth}, weight, RandomStream(options_.seed, path.cell, place));
}

void ViewTracer::see_surface(const Vertex& vertex, double weight, SurfaceDomain& surface) const {
  // On a tile with so many texels that no footprint is smaller than one of them.
  const Vec2 finest = tile_ * (kFinestTexels / std::max(tile_.x, tile_.y));
  add_seen(surface, footprint_taps(vertex.site.footprint, finest).level, vertex.site.uv, weight);
  const Vec3 wv = above_horizon(vertex.wv);
  add_view(surface.views, {wv.x, wv.y, vertex.site.back ? -wv.z : wv.z}, weight);
}

void ViewTracer::go_on(const Vertex& vertex, const Path& path) {
  PathNumbers numbers = path.numbers;
  arena_.reset();
  const PreparedSurface prepared(SurfaceSampling::material, vertex, {}, arena_);
  const auto continuation = sample_continuation(vertex, prepared, scene_.rec709_to_working(), path.throughput,
                                                numbers.point(Purpose::continuation));
  if (!continuation || !std::isfinite(luminance(continuation->throughput))) return;
  numbers.next_vertex();
  next_.push_back({numbers, continuation->throughput, path.cell, vertex.cone});
  next_rays_.push_back(continuation->ray);
  kinds_.push_back(vertex.kind_along(continuation->ray.direction));
}

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
  if (bounces > 0) add_surfaces(vertex, bounces, key, half);
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

void HitLightRecorder::add_surfaces(const Vertex& vertex, int bounces, uint64_t key, int half) {
  rays_.clear();
  kinds_.clear();
  for (const IncidentLight::Path& path : incident_.paths) {
    rays_.push_back(path.along.ray);
    kinds_.push_back(vertex.kind_along(path.along.ray.direction));
  }
  hits_.resize(rays_.size());
  passed_.assign(rays_.size(), Rgb(1.0f));
  visible_.intersect(rays_, hits_.data(), {.each = kinds_}, visible_.dims() ? passed_.data() : nullptr);
  IndirectLight& indirect = indirect_[half];
  indirect.clear();
  met_.clear();
  for (size_t i = 0; i < rays_.size(); ++i) {
    if (hits_[i].instance == kNoHit) continue;
    PathNumbers numbers(options_[half], key, static_cast<uint32_t>(i));
    numbers.next_vertex();
    met_.push_back(i);
    indirect.add(rays_[i], vertex.cone, hits_[i], numbers);
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

#include "usage/observe/view_tracer.h"

#include <bit>

#include "material/footprint_taps.h"
#include "material/material.h"
#include "usage/observation.h"

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
    visible_.intersect(rays_, hits_.data(), depth == 0 ? hidden::kFromCamera : hidden::kFromBounces,
                       visible_.dims() ? passed_.data() : nullptr);
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
  seen.view[view_bin(vertex.wv)] += weight;
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
  const Vec3& wv = vertex.wv;
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
}

}  // namespace velour

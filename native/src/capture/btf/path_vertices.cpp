#include "capture/btf/path_vertices.h"

#include <algorithm>
#include "material/material.h"
#include "math/sphere/random.h"
#include "render/path/direction_sampling.h"
#include "render/path/vertex.h"

namespace velour {

namespace {

/// Spreads the 10 bits of `x` to every other bit.
uint32_t spread_bits(uint32_t x) {
  x = (x | (x << 8)) & 0x00ff00ffu;
  x = (x | (x << 4)) & 0x0f0f0f0fu;
  x = (x | (x << 2)) & 0x33333333u;
  return (x | (x << 1)) & 0x55555555u;
}

/// Position along a Z-order curve over the cell, with 1024 steps along each side.
uint32_t morton_code(const Vec2& place_in_cell) {
  const Vec2 steps = glm::clamp(place_in_cell * 1024.0f, Vec2(0), Vec2(1023));
  return spread_bits(static_cast<uint32_t>(steps.x)) | spread_bits(static_cast<uint32_t>(steps.y)) << 1;
}

}  // namespace

void PathVertices::trace(const ViewSetup& view, const TexelBlock& block, TileRays& rays, RayLog* log,
                         const Progress& progress) {
  start(view, block);
  for (uint32_t depth = 0;; ++depth) {
    progress.check();
    hits_.resize(rays_.size());
    rays.intersect(rays_, hits_, log);
    if (cutouts_.any()) pass_cutouts(depth, rays, log);
    meet(depth);
    if (depth == sampling_.bounces) break;
    go_on(depth);
  }
}

uint64_t PathVertices::texel_key(const ViewSetup& view, uint32_t column, uint32_t row) const {
  const uint64_t texel = uint64_t{row} * grid_.width + column;
  return RandomStream(sampling_.seed, view.number, texel).next_bits();
}

/// Key of a vertex, from which its random numbers derive.
uint64_t PathVertices::vertex_key(uint32_t path, uint32_t depth) const {
  const uint32_t sample = path % sampling_.samples;
  return mix64(keys_[path / sampling_.samples] ^ mix64(uint64_t{depth} << 32 | sample));
}

void PathVertices::pass_cutouts(uint32_t depth, TileRays& rays, RayLog* log) {
  ray_keys_.clear();
  for (const uint32_t path : path_of_) ray_keys_.push_back(~vertex_key(path, depth));
  cutouts_.pass(rays_, hits_, ray_keys_, cone_, rays, log);
}

void PathVertices::start(const ViewSetup& view, const TexelBlock& block) {
  paths_ = block.texels() * sampling_.samples;
  vertices_.clear();
  depths_.assign(1, 0);
  vertex_of_.assign((size_t{sampling_.bounces} + 1) * paths_, kNone);
  keys_.clear();
  rays_.clear();
  path_of_.clear();
  throughput_.assign(paths_, Rgb(1));
  points_.resize(sampling_.samples);
  const Vec2 texel_size = tile_.period() / Vec2(static_cast<float>(grid_.width), static_cast<float>(grid_.height));
  const float part = std::max(0.125f, 1 / std::sqrt(static_cast<float>(sampling_.samples)));
  cone_.width = part * std::sqrt(texel_size.x * texel_size.y * std::abs(view.wv.z));
  for (uint32_t row = block.row; row < block.row + block.rows; ++row) {
    for (uint32_t column = block.column; column < block.column + block.columns; ++column) {
      keys_.push_back(texel_key(view, column, row));
      sobol_points(keys_.back(), 0, points_);
      const Vec2 corner(static_cast<float>(column), static_cast<float>(row));
      for (const Vec2& u : points_) {
        path_of_.push_back(static_cast<uint32_t>(rays_.size()));
        rays_.push_back({start_above((corner + u) * texel_size, view.wv), 0, -view.wv});
      }
    }
  }
}

/// Where the line of sight through `plane`, a point of the reference plane, enters the shell, moved to the center cell.
Vec3 PathVertices::start_above(const Vec2& plane, const Vec3& wv) const {
  const float z = wv.z > 0 ? tile_.top() : tile_.bottom();
  const float distance = (z - reference_height_) / wv.z;
  const Vec2 place = tile_.into_cell(plane + distance * Vec2(wv));
  // Slightly outside the shell, so that a flat top is hit, too.
  return Vec3(place, z) + (tile_.thickness() + tile_.period().x) * 1e-5f * wv;
}

void PathVertices::meet(uint32_t depth) {
  order_.clear();
  for (uint32_t i = 0; i < rays_.size(); ++i) {
    if (hits_[i].instance == kNoHit) continue;
    const Vec2 place = Vec2(rays_[i].origin + hits_[i].distance * rays_[i].direction);
    // First hits of neighboring texels are already neighbors.
    const uint64_t code = depth == 0 ? 0 : morton_code(tile_.into_cell(place) / tile_.period());
    order_.push_back(code << 32 | i);
  }
  if (depth > 0) std::sort(order_.begin(), order_.end());
  for (const uint64_t entry : order_) {
    const auto i = static_cast<uint32_t>(entry);
    const Hit hit = tile_.of_scene(hits_[i]);
    const SurfacePoint point = tile_.surface(hit);
    vertex_of_[size_t{depth} * paths_ + path_of_[i]] = static_cast<uint32_t>(vertices_.size());
    vertices_.push_back(
        {Vertex(tile_.scene(), point, rays_[i], hit, cone_, nullptr), throughput_[i], vertex_key(path_of_[i], depth)});
  }
  depths_.push_back(static_cast<uint32_t>(vertices_.size()));
}

void PathVertices::go_on(uint32_t depth) {
  rays_.clear();
  throughput_.clear();
  path_of_.clear();
  for (uint32_t path = 0; path < paths_; ++path) {
    const uint32_t v = vertex_of(path, depth);
    if (v == kNone) continue;
    const PathVertex& from = vertices_[v];
    const uint64_t key = mix64(keys_[path / sampling_.samples] + depth + 1);
    Vec2 u;
    sobol_points(key, path % sampling_.samples, {&u, 1});
    arena_.reset();
    const PreparedSurface prepared(SurfaceSampling::material, from.vertex, {}, arena_);
    const auto continuation =
        sample_continuation(from.vertex, prepared, tile_.scene().rec709_to_working(), from.throughput, u);
    if (!continuation || !std::isfinite(luminance(continuation->throughput))) continue;
    rays_.push_back(continuation->ray);
    throughput_.push_back(continuation->throughput);
    path_of_.push_back(path);
  }
}

Cutouts::Cutouts(const RepeatedTile& tile) : tile_(tile) {
  for (const SurfaceMaterial& m : tile.scene().materials()) {
    any_ = any_ || m.material->alpha(SurfaceSite::everywhere()) < 1;
  }
}

/// Whether the ray passes through the surface; `from` is where it continues.
bool Cutouts::goes_on(const Ray& ray, const Hit& hit, uint64_t key, int crossing, const RayCone& cone,
                      Vec3& from) const {
  const Hit of_scene = tile_.of_scene(hit);
  const Vertex vertex(tile_.scene(), tile_.surface(of_scene), ray, of_scene, cone, nullptr);
  const float alpha = vertex.surface->material->alpha(vertex.site);
  from = vertex.position - vertex.offset * vertex.geometric_normal;
  return unit_float(mix64(key + static_cast<uint64_t>(crossing))) >= alpha;
}

void Cutouts::pass(std::span<Ray> rays, std::span<Hit> hits, std::span<const uint64_t> keys, const RayCone& cone,
                   TileRays& tracer, RayLog* log) {
  ids_.clear();
  for (uint32_t i = 0; i < rays.size(); ++i) ids_.push_back(i);
  for (int crossing = 0; crossing < kMaxCrossings; ++crossing) {
    next_.clear();
    size_t kept = 0;
    for (const uint32_t i : ids_) {
      Vec3 from;
      if (hits[i].instance == kNoHit || !goes_on(rays[i], hits[i], keys[i], crossing, cone, from)) continue;
      next_.push_back({from, 0, rays[i].direction});
      ids_[kept++] = i;
    }
    ids_.resize(kept);
    if (ids_.empty()) return;
    next_hits_.resize(kept);
    tracer.intersect(next_, next_hits_, log);
    for (size_t n = 0; n < kept; ++n) {
      rays[ids_[n]] = next_[n];
      hits[ids_[n]] = next_hits_[n];
    }
  }
  for (const uint32_t i : ids_) hits[i].instance = kNoHit;
}

}  // namespace velour

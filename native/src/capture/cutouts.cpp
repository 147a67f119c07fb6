#include "capture/cutouts.h"

#include "material/material.h"
#include "render/vertex.h"
#include "sphere/random.h"

namespace velour {

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
  for (int crossing = 0; crossing < kMostCrossings; ++crossing) {
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

#include "capture/shadow_masks.h"

#include <algorithm>

#include "sphere/random.h"

namespace velour {

void ShadowMasks::trace(const PathVertices& paths, std::span<const CaptureLight> lights, TileRays& rays, RayLog* log,
                        const Progress& progress) {
  read(paths);
  for (uint32_t l = 0; l < lights.size(); ++l) {
    progress.check();
    try_light(paths, lights[l], l, rays, log);
  }
}

void ShadowMasks::read(const PathVertices& paths) {
  masks_.assign(paths.vertices().size(), Mask{});
  facing_.clear();
  for (const PathVertex& v : paths.vertices()) {
    const Vec3 origin = v.vertex.position + v.vertex.offset * v.vertex.geometric_normal;
    facing_.push_back({origin, v.vertex.geometric_normal, v.vertex.frame.z});
  }
}

/// Rays to the light from all vertices that face it; how many.
size_t ShadowMasks::collect_facing(const CaptureLight& light) {
  rays_.resize(facing_.size() + 1);
  ids_.resize(facing_.size() + 1);
  size_t count = 0;
  // Written without a branch: which vertices face a light cannot be foreseen.
  for (uint32_t v = 0; v < facing_.size(); ++v) {
    const Facing& f = facing_[v];
    rays_[count].origin = f.origin;
    ids_[count] = v;
    count += static_cast<size_t>(std::min(glm::dot(f.geometric, light.wl), glm::dot(f.shading, light.wl)) > 0.0f);
  }
  rays_.resize(count);
  for (Ray& ray : rays_) {
    ray.near = 0.0f;
    ray.direction = light.wl;
  }
  return count;
}

void ShadowMasks::try_light(const PathVertices& paths, const CaptureLight& light, uint32_t bit, TileRays& rays,
                            RayLog* log) {
  const size_t count = collect_facing(light);
  blocked_.resize(count);
  if (cutouts_.any()) {
    trace_through_cutouts(paths, light, rays, log);
  } else {
    rays.occluded(rays_, blocked_, light.ends, log);
  }
  for (size_t i = 0; i < count; ++i) {
    masks_[ids_[i]][bit / 64] |= uint64_t{blocked_[i] == 0} << (bit % 64);
  }
}

void ShadowMasks::trace_through_cutouts(const PathVertices& paths, const CaptureLight& light, TileRays& rays,
                                        RayLog* log) {
  hits_.resize(rays_.size());
  keys_.clear();
  for (size_t i = 0; i < rays_.size(); ++i) keys_.push_back(mix64(paths.vertices()[ids_[i]].key + light.number));
  rays.intersect(rays_, hits_, log);
  cutouts_.pass(rays_, hits_, keys_, paths.cone(), rays, log);
  for (size_t i = 0; i < hits_.size(); ++i) blocked_[i] = hits_[i].instance != kNoHit;
}

}  // namespace velour

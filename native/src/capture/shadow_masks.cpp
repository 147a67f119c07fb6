#include "capture/shadow_masks.h"

namespace velour {

void ShadowMasks::trace(const PathVertices& paths, std::span<const CaptureLight> lights, TileRays& rays, RayLog* log,
                        const Progress& progress) {
  read(paths);
  for (uint32_t l = 0; l < lights.size(); ++l) {
    progress.check();
    try_light(lights[l], l, rays, log);
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

void ShadowMasks::try_light(const CaptureLight& light, uint32_t number, TileRays& rays, RayLog* log) {
  rays_.resize(facing_.size());
  ids_.resize(facing_.size());
  size_t count = 0;
  // Written without a branch: which vertices face a light cannot be foreseen.
  for (uint32_t v = 0; v < facing_.size(); ++v) {
    const Facing& f = facing_[v];
    rays_[count].origin = f.origin;
    ids_[count] = v;
    count += static_cast<size_t>(std::min(glm::dot(f.geometric, light.wl), glm::dot(f.shading, light.wl)) > 0.0f);
  }
  for (size_t i = 0; i < count; ++i) {
    rays_[i].near = 0.0f;
    rays_[i].direction = light.wl;
  }
  blocked_.resize(count);
  rays.occluded({rays_.data(), count}, blocked_, light.ends, log);
  for (size_t i = 0; i < count; ++i) {
    masks_[ids_[i]][number / 64] |= uint64_t{blocked_[i] == 0} << (number % 64);
  }
}

}  // namespace velour

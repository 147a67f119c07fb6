#include "capture/shadow_masks.h"

#include <algorithm>

#include "sphere/random.h"

namespace velour {
namespace {

/// Number of rays traced at a time: few enough for the caches, and whole packets of the ray tracer.
constexpr size_t kRaysTogether = 2048;

}  // namespace

void ShadowMasks::trace(const PathVertices& paths, const LightGroup& group, TileRays& rays, RayLog* log,
                        const Progress& progress) {
  read(paths);
  for (uint32_t l = 0; l < group.count(); ++l) {
    progress.check();
    try_light(paths, group.lights[l], l, rays, log);
  }
}

void ShadowMasks::read(const PathVertices& paths) {
  masks_.assign(paths.vertices().size(), Mask{});
  normals_.clear();
  origins_.clear();
  for (const PathVertex& v : paths.vertices()) {
    normals_.push(v.vertex.geometric_normal, v.vertex.frame.z);
    origins_.push_back(v.vertex.position + v.vertex.offset * v.vertex.geometric_normal);
  }
}

void ShadowMasks::try_light(const PathVertices& paths, const CaptureLight& light, uint32_t bit, TileRays& rays,
                            RayLog* log) {
  facing_places(normals_, light.wl, facing_);
  for (size_t done = 0; done < facing_.size(); done += kRaysTogether) {
    ids_ = std::span(facing_).subspan(done, std::min(kRaysTogether, facing_.size() - done));
    trace_some(paths, light, rays, log);
    note_reached(bit);
  }
}

void ShadowMasks::note_reached(uint32_t bit) {
  const uint8_t* blocked = blocked_.data();  // bytes may alias: these copies avoid reloading all pointers
  Mask* masks = masks_.data();
  const uint32_t* ids = ids_.data();
  const size_t count = ids_.size();
  const uint32_t word = bit / 64, shift = bit % 64;
  for (size_t i = 0; i < count; ++i) masks[ids[i]][word] |= uint64_t{blocked[i] == 0} << shift;
}

void ShadowMasks::trace_some(const PathVertices& paths, const CaptureLight& light, TileRays& rays, RayLog* log) {
  rays_.resize(ids_.size());
  for (size_t i = 0; i < ids_.size(); ++i) {
    Ray& ray = rays_[i];
    ray.origin = origins_[ids_[i]];
    ray.near = 0.0f;
    ray.direction = light.wl;  // `far` is set to the end of the shell
  }
  blocked_.resize(ids_.size());
  if (cutouts_.any()) {
    trace_through_cutouts(paths, light, rays, log);
  } else {
    rays.occluded(rays_, blocked_, light.ends, log);
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

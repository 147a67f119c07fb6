// Observes a scene as the renderer would, to find the scene usage of one material.
#pragma once

#include <cstdint>
#include <optional>
#include "base/progress.h"
#include "scene/scene.h"
#include "usage/observation.h"

namespace velour {

struct ObserverOptions {
  int width = 640, height = 480;  // image size, 1..65536; for uniform materials only the ratio matters
  int bounces = 0;                // bounces of the render, 0..1024
  int threads = 0;                // 0: all
  uint64_t seed = 0;
};

/// Throws Error naming the option at fault or what is wrong with the scene.
void check_observer(const Scene& scene, uint32_t material, const ObserverOptions& options);

/// Observes one frame of `material` in a committed scene. A function of scene, options (except threads) and seed, bit
/// for bit. Throws what check_observer throws, and Error(cancelled).
///
/// About 65,536 camera rays, one through a random point of each cell of a grid over the image, continue from bounce to
/// bounce as in the renderer. Every hit of the material, at any depth, adds the luminance of its path's throughput to
/// the view histogram. It also takes part in sampling: it receives the times of a Poisson process whose rate is that
/// weight, the bits of a time are its key, and the kHits earliest times of all hits are kept. Each kept hit is thus an
/// independent sample with probability proportional to weight (a hit may be kept more than once, with different light),
/// and the earliest times of several frames are the same kind of sample from all of them.
///
/// Each half of a kept hit's light holds the renderer's own terms (DirectLight under `mis`, with f left out) of
/// kObservedDirections directions, half of them light-sampled, half from the material's sampler: unoccluded
/// environment, lights and emissive meshes. With remaining bounces, paths continue along the directions from the
/// material and add what surfaces reflect. Delta lights are added one by one: all of up to 64, otherwise 64 sampled by
/// contribution.
///
/// The light density of a hit is the largest density d (Lighting, 1/sr) such that terms of density d or more make up at
/// least kNoticeableLight of the luminance of the hit's irradiance. Light reflected by surfaces counts there and is
/// never concentrated; infinite if delta lights alone suffice.
SceneObservation observe(const Scene& scene, uint32_t material, const ObserverOptions& options, Progress& progress);

constexpr int kObservedDirections = 64;
constexpr double kNoticeableLight = 1e-3;

// Whether the camera is inside an object.

/// The instance that encloses the camera and hides everything else: its back face is the nearest surface in all of many
/// directions from the camera and on all of many rays through the image, and is opaque wherever they hit it. Instances
/// hidden from the camera are ignored. `scene` must be committed.
std::optional<uint32_t> surrounding_instance(const Scene& scene);

}  // namespace velour

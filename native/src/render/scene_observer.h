// Looks at a scene as the renderer would, to learn what it asks of one material.
#pragma once

#include "domain/observation.h"
#include "job/progress.h"
#include "scene/scene.h"

namespace velour {

struct ObserverOptions {
  int width = 640, height = 480;  // of the picture, 1..65536; uniform materials see their ratio alone
  int bounces = 0;                // of its render, 0..1024
  int threads = 0;                // 0: all
  uint64_t seed = 0;
};

/// Throws Error with the option at fault, or what is wrong with the scene.
void check_observer(const Scene& scene, uint32_t material, const ObserverOptions& options);

/// One frame of `material` in a committed scene. A function of scene, options (less threads) and seed, bit for bit.
/// Throws what check_observer throws, and Error(cancelled).
///
/// About 65,536 camera rays, one through a random place of each cell of a grid over the picture, go on from bounce to
/// bounce as the renderer's do. Every hit of the material, at any depth, adds the luminance of its path's throughput to
/// the view histogram. It also takes part in a draw: it receives the times of a Poisson process whose rate is that
/// weight, the bits of a time are a key, and the kHits earliest times of all hits stay. So each kept hit is an
/// independent draw with probability proportional to weight (a hit may be kept more than once, with light of its own),
/// and of several frames the earliest times of all are the same draw from all of them.
///
/// Each half of a kept hit's light holds kObservedDirections directions, half drawn towards light (Lighting), half from
/// the material's sampler, weighted by the balance heuristic [VG95]; environment, lamps and surfaces that glow count
/// where nothing blocks them, and, with bounces left, the radiance that a path traced onwards brings back. Sharp lamps
/// come by name: all of up to 64, else 64 drawn by what they bring.
///
/// The light density of a hit is the largest density d (Lighting, 1/sr) such that terms of density d or more make at
/// least kNoticeableLight of the hit's irradiance luminance, light of surfaces included there and never concentrated;
/// infinite where sharp lamps do.
SceneObservation observe(const Scene& scene, uint32_t material, const ObserverOptions& options, Progress& progress);

constexpr int kObservedDirections = 64;
constexpr double kNoticeableLight = 1e-3;

}  // namespace velour

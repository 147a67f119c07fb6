// What scenes show a material, in enough detail to tell how a picture changes with the material's model.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "domain/scene_domain.h"
#include "sphere/vec.h"

namespace velour {

/// A hit, and where its light comes from: terms [first, middle) and [middle, last) are two independent estimates, so
/// that the product of what a change of f makes of either has the square of the true change as its expectation.
struct ObservedHit {
  uint64_t key;  // hits are kept by their key: those with the smallest ones; the bits of a time (scene_observer.h)
  Vec3 wv;       // local frame
  uint32_t first, middle, last;
  float light_density = 0;  // 1/sr: of this hit what SceneDomain::light_density is of all
  bool back = false;        // SurfaceSite::back: z of wv and of the terms is that of the other side
};

/// Hits are chosen with probability proportional to their weight (SceneDomain), so each counts the same.
struct SceneObservation {
  static constexpr size_t kHits = 1024;

  SceneDomain domain;
  std::vector<ObservedHit> hits;  // by key
  // The terms of all hits: f(wl) . light summed over the terms of a half estimates the radiance that leaves the hit.
  std::vector<Vec3> wl;    // local frame; below the horizon where the material lets light through
  std::vector<Rgb> light;  // radiance x cos / density / number of terms, shadows included; Rec. 709 or working space
};

/// Polar angle of a view above the horizon, radians: what SceneDomain::view is binned by.
inline double theta_of(const Vec3& wv) { return std::acos(std::min(1.0, static_cast<double>(wv.z))); }

/// The same without light from the other side of the surface: what a material that only reflects can answer.
SceneObservation reflected_part(const SceneObservation& observation);

/// Adds what another frame or scene saw; of all hits, the kHits with the smallest keys are kept. The result does not
/// depend on the order of frames.
void merge(SceneObservation& into, const SceneObservation& other);

}  // namespace velour

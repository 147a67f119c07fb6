// Light that waits for its shadow ray. Rays of many vertices are traced together.
#pragma once

#include <cmath>
#include <vector>
#include "render/film/film.h"
#include "render/path/path_numbers.h"
#include "scene/embree_scene.h"
#include "scene/scene.h"

namespace velour {

// Rays that respect the alpha, shells and visibility of surfaces.

/// Like EmbreeScene, but a ray hits a surface of a material that is not opaque with the probability of its alpha there,
/// and otherwise continues straight: correct on average. The decision uses the ray's own numbers, or the bits of ray
/// and triangle, so it depends on neither threads nor order. Shadow rays decide nothing: they pass, dimmed by the
/// alpha. A passed surface may change the color: `passed` of a ray is the factor on its light along the way to its end;
/// it may be null where dims() is false. A shell is hit where its structure is (shell_crossing.h). Thread-safe. Scenes
/// of opaque surfaces without shells are traced directly. Kinds of rays are bits of `hidden`.
class VisibleRays {
 public:
  /// `scene` must be committed, and its materials must not change.
  explicit VisibleRays(const Scene& scene);

  /// Distances are from the origin, whatever was passed on the way. `decisions`: one per ray, or none.
  void intersect(std::span<const Ray> rays, Hit* hits, const RayKinds& kinds = {hidden::kFromBounces},
                 Rgb* passed = nullptr, std::span<const RayDecisions> decisions = {}) const;
  bool occluded(const Ray& ray, Rgb* passed = nullptr) const;
  /// Batch version, as in EmbreeScene::occluded.
  void occluded(std::span<const Ray> rays, uint8_t* blocked, Rgb* passed = nullptr) const;

  /// Whether an instance is hidden from rays of `kind` or from shadow rays, but not from both.
  bool tells_apart(uint8_t kind) const { return (apart_ & kind) != 0; }
  /// Whether rays may pass through surfaces. Otherwise `passed` is always 1, and there is nothing to decide.
  bool dims() const { return dims_; }
  /// Whether rays of a kind simply hit the nearest surface that they see, and shadow rays see the same as those that
  /// continue a path.
  bool plain() const { return all_opaque_ && apart_ == 0; }

 private:
  struct Pending;
  /// Replaces `hits`, the nearest surfaces of at most as many `rays` as Pending holds, by the nearest that do not let
  /// the rays pass.
  void pass_on(std::span<const Ray> rays, Hit* hits, const RayKinds& kinds, Rgb* passed,
               std::span<const RayDecisions> decisions) const;
  /// Decides which of the pending rays hit the surfaces that they have reached. Multiplies what passes into `passed`,
  /// by index of the ray.
  void decide(Pending& pending, bool* met, Rgb* passed, std::span<const RayDecisions> decisions) const;
  bool meets_surface(Pending& pending, size_t i, Rgb* passed, std::span<const RayDecisions> decisions) const;
  void occluded_some(std::span<const Ray> rays, uint8_t* blocked, Rgb* passed) const;

  const Scene& scene_;
  const bool shells_;
  const bool all_opaque_;
  const bool dims_;
  uint8_t apart_ = 0;  // kinds that tells_apart()
};

class RayLog;

class ShadowQueue {
 public:
  /// Adds `light` to sample `sample` unless something blocks `ray`, clamped to the sum `limit` of its channels.
  /// `kind`: a bit of `hidden`.
  void add(const Ray& ray, const Rgb& light, uint32_t sample, float limit, uint8_t kind) {
    rays_.push_back(ray);
    kinds_.push_back(kind);
    light_.push_back(light);
    sample_.push_back(sample);
    limit_.push_back(limit);
  }
  /// Traces all rays, adds the light that arrives to `samples` in the order of add(), and empties the queue. Returns
  /// the number of rays. `log` may be null.
  size_t resolve(const VisibleRays& visible, std::vector<CameraSample>& samples, RayLog* log);

 private:
  std::vector<Ray> rays_;
  std::vector<uint8_t> kinds_;
  std::vector<Rgb> light_;
  std::vector<uint32_t> sample_;
  std::vector<float> limit_;
  std::vector<uint8_t> blocked_;
  std::vector<Rgb> passed_;  // if rays may pass through surfaces
};

// Rays that continue straight behind a surface.

/// Makes a ray start behind its hit.
inline void go_beyond(Ray& ray, const Hit& hit) {
  constexpr float kStep = 0x1p-20f;  // relative to the distance: the error of the ray tracer
  ray.near = std::nextafter(hit.distance * (1.0f + kStep), ray.far);
}

/// A ray crosses a triangle only once: a second hit is the same crossing, found again through rounding.
inline bool same_crossing(const Hit& hit, const Hit& passed) {
  return hit.instance == passed.instance && hit.triangle == passed.triangle;
}

}  // namespace velour

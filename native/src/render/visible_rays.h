// Rays that respect the alpha, shells and visibility of surfaces.
#pragma once

#include "render/ray_number.h"
#include "scene/scene.h"

namespace velour {

/// Like EmbreeScene, but a ray hits a surface of a material that is not opaque with the probability of its alpha there,
/// and otherwise continues straight: correct on average. The decision uses the ray's own numbers, or the bits of ray
/// and triangle, so it depends on neither threads nor order. Shadow rays decide nothing: they pass, dimmed by the
/// alpha. A passed surface may change the color: `passed` of a ray is the factor on its light along the way to its end;
/// it may be null where dims() is false. A shell is hit where its structure is (shell_crossing.h). An instance that is
/// hidden from a kind of ray is not hit by it. Thread-safe. Scenes without any of these are traced directly.
class VisibleRays {
 public:
  /// `scene` must be committed, and its materials must not change.
  explicit VisibleRays(const Scene& scene);

  /// Distances are from the origin, whatever was passed on the way. `kind`: a bit of `hidden`. `decisions`: one per
  /// ray, or none.
  void intersect(std::span<const Ray> rays, Hit* hits, uint8_t kind = hidden::kFromBounces, Rgb* passed = nullptr,
                 std::span<const RayDecisions> decisions = {}) const;
  bool occluded(const Ray& ray, Rgb* passed = nullptr) const;
  /// Batch version, as in EmbreeScene::occluded.
  void occluded(std::span<const Ray> rays, uint8_t* blocked, Rgb* passed = nullptr) const;

  /// Whether rays may pass through surfaces. Otherwise `passed` is always 1, and there is nothing to decide.
  bool dims() const { return dims_; }
  /// Whether shadow and bounce rays simply hit the nearest surface.
  bool plain() const { return sees_all(hidden::kFromShadows | hidden::kFromBounces); }

 private:
  struct Pending;
  /// Replaces `hits`, the nearest surfaces of at most as many `rays` as Pending holds, by the nearest that do not let
  /// the rays pass.
  void pass_on(std::span<const Ray> rays, Hit* hits, uint8_t kind, Rgb* passed,
               std::span<const RayDecisions> decisions) const;
  /// Decides which of the pending rays hit the surfaces that they have reached. Multiplies what passes into `passed`,
  /// by index of the ray.
  void decide(Pending& pending, uint8_t kind, bool* met, Rgb* passed, std::span<const RayDecisions> decisions) const;
  bool meets_surface(Pending& pending, size_t i, uint8_t kind, Rgb* passed,
                     std::span<const RayDecisions> decisions) const;
  bool sees_all(uint8_t kind) const { return all_opaque_ && (hidden_ & kind) == 0; }
  void occluded_some(std::span<const Ray> rays, uint8_t* blocked, Rgb* passed) const;

  const Scene& scene_;
  const bool shells_;
  const bool all_opaque_;
  const bool dims_;
  uint8_t hidden_ = 0;  // union over all instances
};

}  // namespace velour

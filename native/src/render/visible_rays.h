// Rays that see what is there of every surface.
#pragma once

#include "render/ray_number.h"
#include "scene/scene.h"

namespace velour {

/// As EmbreeScene's, but a ray meets a surface of a material that is not opaque with the probability of its alpha
/// there, and goes on straight otherwise: right on average. Whether it does is drawn with the ray's own numbers, or
/// with bits of ray and triangle, so that it depends on neither threads nor order. Shadow rays draw nothing: they pass,
/// dimmed by the alpha. What passes may change its colour: `passed` of a ray is what its light is multiplied with on
/// the way to where it ends; it may be null where dims() is false. A shell is met where its structure is
/// (shell_crossing.h). An instance that is hidden from a kind of ray is not met by it. Thread-safe; scenes without any
/// of that are traced as they are.
class VisibleRays {
 public:
  /// `scene` is committed, and its materials stay.
  explicit VisibleRays(const Scene& scene);

  /// Distances are from the origin, whatever was passed on the way. `kind`: a bit of `hidden`. `decisions`: of each
  /// ray, or none.
  void intersect(std::span<const Ray> rays, Hit* hits, uint8_t kind = hidden::kFromBounces, Rgb* passed = nullptr,
                 std::span<const RayDecisions> decisions = {}) const;
  bool occluded(const Ray& ray, Rgb* passed = nullptr) const;
  /// A batch, as EmbreeScene::occluded.
  void occluded(std::span<const Ray> rays, uint8_t* blocked, Rgb* passed = nullptr) const;

  /// Whether rays may pass what they come to: else `passed` is 1 of all, and there is nothing to decide.
  bool dims() const { return dims_; }
  /// Whether shadow rays and those of bounces simply meet the nearest surface.
  bool plain() const { return sees_all(hidden::kFromShadows | hidden::kFromBounces); }

 private:
  struct Pending;
  /// Replaces `hits`, the nearest ones of at most as many `rays` as Pending holds, by the nearest that they meet.
  void pass_on(std::span<const Ray> rays, Hit* hits, uint8_t kind, Rgb* passed,
               std::span<const RayDecisions> decisions) const;
  /// Which of the pending rays meet what they have come to; what passes is multiplied into `passed`, by number of ray.
  void decide(Pending& pending, uint8_t kind, bool* met, Rgb* passed, std::span<const RayDecisions> decisions) const;
  bool meets_surface(Pending& pending, size_t i, uint8_t kind, Rgb* passed,
                     std::span<const RayDecisions> decisions) const;
  bool sees_all(uint8_t kind) const { return all_opaque_ && (hidden_ & kind) == 0; }
  void occluded_some(std::span<const Ray> rays, uint8_t* blocked, Rgb* passed) const;

  const Scene& scene_;
  const bool shells_;
  const bool all_opaque_;
  const bool dims_;
  uint8_t hidden_ = 0;  // of any instance
};

}  // namespace velour

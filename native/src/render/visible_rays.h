// Rays that see what is there of every surface.
#pragma once

#include "scene/scene.h"

namespace velour {

/// As EmbreeScene's, but a ray meets a surface of a material that is not opaque with the probability of its alpha
/// there, and goes on straight otherwise: right on average, for camera, bounce and shadow rays alike. Whether it does
/// is drawn with bits of ray and triangle, so that it depends on neither threads nor order. What passes may change its
/// colour: `passed` (may be null) of a ray is what its light is multiplied with on the way to where it ends. A shell is
/// met where its structure is (shell_crossing.h). An instance that is hidden from a kind of ray is not met by it.
/// Thread-safe; scenes without any of that are traced as they are.
class VisibleRays {
 public:
  /// `scene` is committed, and its materials stay.
  explicit VisibleRays(const Scene& scene);

  /// Distances are from the origin, whatever was passed on the way. `kind`: a bit of `hidden`.
  void intersect(std::span<const Ray> rays, Hit* hits, uint8_t kind = hidden::kFromBounces,
                 Rgb* passed = nullptr) const;
  bool occluded(const Ray& ray, Rgb* passed = nullptr) const;
  /// A batch, as EmbreeScene::occluded.
  void occluded(std::span<const Ray> rays, uint8_t* blocked, Rgb* passed = nullptr) const;

  /// False: `passed` is 1 of every ray, and need not be asked for.
  bool tints() const { return tints_; }

 private:
  struct Pending;
  /// Replaces `hits`, the nearest ones of at most as many `rays` as Pending holds, by the nearest that they meet.
  void pass_on(std::span<const Ray> rays, Hit* hits, uint8_t kind, Rgb* passed) const;
  /// Which of the pending rays meet what they have come to; what passes is multiplied into `passed`, by number of ray.
  void decide(Pending& pending, uint8_t kind, bool* met, Rgb* passed) const;
  bool meets_surface(const Ray& ray, const Hit& hit, uint8_t kind, Rgb* passed) const;
  bool sees_all(uint8_t kind) const { return all_opaque_ && (hidden_ & kind) == 0; }
  void occluded_some(std::span<const Ray> rays, uint8_t* blocked, Rgb* passed) const;

  const Scene& scene_;
  const bool shells_;
  const bool all_opaque_;
  const bool tints_;
  uint8_t hidden_ = 0;  // of any instance
};

}  // namespace velour

// Light that comes through a surface to its viewer, beside light that the surface sends back.
#pragma once

#include <memory>

#include "material/material.h"

namespace velour {

/// f of `reflected` where the light is on the viewer's side, of `through` where it is on the other one. Both are asked
/// with directions of z > 0: those of `through` are mirrored in the surface. A sample is drawn from `through` with the
/// probability of its share of what both give under even light from everywhere, seen from the same side of the surface:
/// at least kLeastShare, at most 1 - kLeastShare. There are no proposal lobes: `product` is `mis` here.
class ThroughMaterial final : public Material {
 public:
  ThroughMaterial(std::shared_ptr<const Material> reflected, std::shared_ptr<const Material> through);
  static constexpr float kLeastShare = 0.1f;

  void prepare(const Vec3& wv, const SurfaceSite& site, PreparedBrdf& point) const override;
  void eval(const PreparedBrdf& point, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) const override;
  Reflection eval_one(const PreparedBrdf& point, const Vec3& wl) const override;
  void sample(const PreparedBrdf& point, std::span<const Vec2> u, DirectionBatch& wl) const override;
  float diffuse_share(const PreparedBrdf& point, const Vec3& wl, float pdf) const override;

  bool transmits() const override { return true; }
  bool varies() const override { return true; }
  Vec2 texels() const override { return reflected_->texels(); }
  bool isotropic() const override { return false; }
  /// Of samples, seen from the front and from behind.
  float share(bool back) const { return share_[back]; }

 private:
  std::shared_ptr<const Material> reflected_, through_;
  float share_[2];
};

}  // namespace velour

// Materials made of others: with their own texture coordinates, or with transmitted light.
#pragma once

#include <memory>
#include "material/material.h"
#include "material/texture.h"

namespace velour {

// Materials with texture coordinates of their own.

/// Texture coordinates of a material: `map` (u, v) of the surface's. Tiles are then rotated counterclockwise about the
/// origin by `rotation` (radians) and enlarged by `scale` (at least kMinScale) where these are given.
struct Placing {
  static constexpr float kMinScale = 1e-3f;

  TextureMap map{};
  TextureSlot<float> rotation{}, scale{};
  float aspect = 1;  // width of a tile divided by its height, above 0

  bool varies() const { return rotation.given() || scale.given(); }
};

/// `material` on these texture coordinates, and turned with them about the normal: its +x is the direction in which its
/// own u grows. Assumes that u and v of `map` grow at right angles, and equally fast except for the aspect, as in most
/// unwrapped meshes. The map must be invertible. Returns `material` itself where this changes nothing.
std::shared_ptr<const Material> make_placed(std::shared_ptr<const Material> material, const Placing& placing);

// Material that transmits light in addition to reflecting it.

/// f of `reflected` for light on the viewer's side, of `through` for light on the other side. Both are evaluated with
/// directions of z > 0; those of `through` are mirrored in the surface. `through` is sampled with the probability of
/// its share of the albedo of both under uniform light, seen from the same side of the surface: at least kMinShare,
/// at most 1 - kMinShare. There are no proposal lobes: `product` acts as `mis`.
class ThroughMaterial final : public Material {
 public:
  ThroughMaterial(std::shared_ptr<const Material> reflected, std::shared_ptr<const Material> through);
  static constexpr float kMinShare = 0.1f;

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override;

  bool transmits() const override { return true; }
  bool varies() const override { return true; }
  Vec2 texels() const override { return reflected_->texels(); }
  bool isotropic() const override { return false; }
  /// Probability of sampling `through`, seen from the front or from behind.
  float share(bool back) const { return share_[back]; }

 private:
  std::shared_ptr<const Material> reflected_, through_;
  float share_[2];
};

}  // namespace velour

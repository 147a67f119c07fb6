// Blender's Principled BSDF, uniform or textured.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/principled/principled_point.h"
#include "material/texture_slot.h"

namespace velour {

struct PrincipledTextures {
  TextureSlot<Rgb> base_color{};
  TextureSlot<float> metallic{}, roughness{}, alpha{};

  bool varies() const { return base_color.given() || metallic.given() || roughness.given(); }
  bool any() const { return varies() || alpha.given(); }
};

/// Samples the cosine, the normals of the lobe or the coat, sheen or glass, in proportion to their albedos. Isotropic.
class PrincipledMaterial final : public Material {
 public:
  /// Each parameter is averaged over the footprint separately. This is exact for the base color of distant surfaces,
  /// but a mean of rough and smooth is rendered as one roughness in between. `alpha` applies if it has no texture.
  explicit PrincipledMaterial(const PrincipledParameters& parameters, const PrincipledTextures& textures = {},
                              float alpha = 1);

  const PreparedBrdf* prepare(const Vec3& wv, const SurfaceSite& site, const PrepareOptions& options,
                              ScratchArena& arena) const override;

  bool isotropic() const override { return true; }
  bool transmits() const override;
  bool varies() const override { return textures_.any(); }
  bool opaque() const override { return !textures_.alpha.given() && alpha_ >= 1; }
  float alpha(const SurfaceSite& site) const override;

 private:
  const PrincipledParameters parameters_;
  const PrincipledTextures textures_;
  const float alpha_;
};

/// f and sampling density at `point` of each direction; the batch is padded. SIMD, dispatched at run time.
void eval_principled(const PrincipledPoint& point, const Vec3& wv, const DirectionBatch& wl, RgbBatch& f,
                     ScalarBatch& pdf);

std::shared_ptr<const Material> make_principled_material(const PrincipledParameters& parameters,
                                                         const PrincipledTextures& textures = {}, float alpha = 1);

}  // namespace velour

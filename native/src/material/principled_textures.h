// Principled materials whose parameters are pictures.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/principled_lobes.h"
#include "material/texture_slot.h"

namespace velour {

struct PrincipledTextures {
  TextureSlot<Rgb> base_color{};
  TextureSlot<float> metallic{}, roughness{}, alpha{};

  bool any() const { return base_color.given() || metallic.given() || roughness.given() || alpha.given(); }
};

/// Parameters are averaged over the footprint, each by itself: exact for the base colour of what is far away, while the
/// mean of rough and smooth is shown as one roughness between them. `alpha` holds where it has no texture.
std::shared_ptr<const Material> make_textured_material(const PrincipledParameters& parameters,
                                                       const PrincipledTextures& textures, float alpha);

}  // namespace velour

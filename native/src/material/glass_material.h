// Blender's Glass and Refraction BSDFs, and its Translucent BSDF.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/microfacet/glass_lobe.h"
#include "material/texture_slot.h"

namespace velour {

struct GlassTextures {
  TextureSlot<Rgb> color{};        // replaces both tints
  TextureSlot<float> roughness{};  // replaces both roughnesses
};

/// A dielectric with a GlassLobe. Light that passes meets the back of another such surface, or another material, as the
/// scene has it: overlapping objects are not recognized.
std::shared_ptr<const Material> make_glass_material(const GlassParameters& parameters,
                                                    const GlassTextures& textures = {});

/// f = color / pi for light from the other side.
std::shared_ptr<const Material> make_translucent_material(const Rgb& color, const TextureSlot<Rgb>& texture = {});

}  // namespace velour

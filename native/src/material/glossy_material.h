// Blender's Glossy BSDF: microfacets that reflect one color at every angle.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/microfacet/ggx.h"
#include "material/texture_slot.h"

namespace velour {

struct GlossyParameters {
  Rgb color{0.8f};
  float roughness = 0.5f;  // GGX alpha is its square; clamped to at least kMinRoughness
  GgxLobe lobe = GgxLobe::whole;
  TextureSlot<Rgb> color_texture{};
  TextureSlot<float> roughness_texture{};
};

/// f = color G2 D / (4 cos cos), scaled by the lobe's Interreflection. Samples the visible normals.
std::shared_ptr<const Material> make_glossy_material(const GlossyParameters& parameters);

}  // namespace velour

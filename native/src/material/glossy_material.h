// Surfaces of microfacets that reflect one colour at every angle: Blender's Glossy BSDF.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/texture_slot.h"

namespace velour {

struct GlossyParameters {
  Rgb color{0.8f};
  float roughness = 0.5f;  // alpha of GGX: its square; at least kMinRoughness is rendered
  GgxLobe lobe = GgxLobe::whole;
  TextureSlot<Rgb> color_texture{};
  TextureSlot<float> roughness_texture{};
};

/// color G2 D / (4 cos cos), and what the lobe makes of it. Samples are drawn from visible normals.
std::shared_ptr<const Material> make_glossy_material(const GlossyParameters& parameters);

}  // namespace velour

// Blender's Diffuse, Glossy, Glass, Refraction and Translucent BSDFs.
#pragma once

#include <memory>
#include "material/material.h"
#include "material/microfacet/ggx.h"
#include "material/microfacet/glass_lobe.h"
#include "material/texture.h"

namespace velour {

// Blender's Diffuse BSDF: diffuse facets that shadow each other.

struct RoughDiffuseParameters {
  Rgb color{0.8f};
  float roughness = 0;  // 0: Lambert
  /// Includes light reflected between facets.
  bool interreflection = false;
  TextureSlot<Rgb> color_texture{};
  TextureSlot<float> roughness_texture{};
};

/// Fujii's variant of the Oren-Nayar model ([ON94]; mimosa-pudica.net/improved-oren-nayar.html, "a tiny improvement"):
/// color (A + B s / t) with s = cos(phi) sin sin of both angles, t the larger cosine where s > 0, else 1, A = 1 / (pi +
/// (pi/2 - 2/3) roughness), B = roughness A. Interreflection adds the lobe that makes a white surface reflect all light
/// and a colored one more saturated, as in OpenPBR's energy-preserving model ([PKH25], and Cycles since Blender 4.3,
/// with one more power of color than the paper): color^3 m (1 - E(wv)) (1 - E(wl)) / (pi (1 - m) (1 - color (1 - m))),
/// where E is the albedo of the sum above for white and m its cosine-weighted mean. Sampling is cosine-weighted.
std::shared_ptr<const Material> make_rough_diffuse_material(const RoughDiffuseParameters& parameters);

// Blender's Glossy BSDF: microfacets that reflect one color at every angle.

struct GlossyParameters {
  Rgb color{0.8f};
  float roughness = 0.5f;  // GGX alpha is its square; clamped to at least kMinRoughness
  GgxLobe lobe = GgxLobe::whole;
  TextureSlot<Rgb> color_texture{};
  TextureSlot<float> roughness_texture{};
};

/// f = color G2 D / (4 cos cos), scaled by the lobe's Interreflection. Samples the visible normals.
std::shared_ptr<const Material> make_glossy_material(const GlossyParameters& parameters);

// Blender's Glass and Refraction BSDFs, and its Translucent BSDF.

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

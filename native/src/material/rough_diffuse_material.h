// Blender's Diffuse BSDF: diffuse facets that shadow each other.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/texture_slot.h"

namespace velour {

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

}  // namespace velour

// Diffuse surfaces of facets that shade each other: Blender's Diffuse BSDF.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/texture_slot.h"

namespace velour {

struct RoughDiffuseParameters {
  Rgb color{0.8f};
  float roughness = 0;  // 0: Lambert
  /// Light that facets send to each other counts.
  bool interreflection = false;
  TextureSlot<Rgb> color_texture{};
  TextureSlot<float> roughness_texture{};
};

/// Fujii's version of the model of Oren and Nayar ([ON94]; mimosa-pudica.net/improved-oren-nayar.html, "a tiny
/// improvement"): color (A + B s / t) with s = cos(phi) sin sin of both angles, t the larger cosine where s > 0, else
/// 1, A = 1 / (pi + (pi/2 - 2/3) roughness), B = roughness A. Interreflection adds the lobe that makes a white surface
/// reflect all light and a coloured one more saturated, as OpenPBR's energy-keeping model does ([PKH25], and Cycles
/// since Blender 4.3, with a power of color more than the paper): color^3 m (1 - E(wv)) (1 - E(wl)) / (pi (1 - m) (1 -
/// color (1 - m))), E the albedo of the sum above for white and m its cosine-weighted mean. Samples are drawn by the
/// cosine.
std::shared_ptr<const Material> make_rough_diffuse_material(const RoughDiffuseParameters& parameters);

}  // namespace velour

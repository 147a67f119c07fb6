// Materials that are mixed and added of others, with what lets light through and what glows.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "material/material.h"
#include "material/principled_point.h"
#include "material/texture_slot.h"

namespace velour {

/// One of the numbers whose product is the weight of a layer.
struct LayerFactor {
  /// Of a mix, its factor or 1 minus that, within [0, 1]; or any number that is not negative.
  enum class Kind : int { share = 0, rest = 1, gain = 2 };  // values of velour.h
  Kind kind = Kind::share;
  float value = 1;
  TextureSlot<float> texture{};  // in its place

  float at(const SurfaceSite& site) const;
};

/// Empty: 1.
struct LayerWeight {
  std::vector<LayerFactor> factors{};

  float at(const SurfaceSite& site) const;
  bool varies() const;
};

/// What reflects; its own alpha and emission are not looked at.
struct ReflectingLayer {
  std::shared_ptr<const Material> material;
  LayerWeight weight{};
  /// Below the coat of these parameters, which dims it as seen from the surface's own normal, however a normal map
  /// turns the material.
  std::optional<PrincipledParameters> coated{};
};

/// What lets light through with a colour, or glows with a radiance.
struct ColorLayer {
  Rgb color{1.0f};
  TextureSlot<Rgb> texture{};
  LayerWeight weight{};

  Rgb at(const SurfaceSite& site) const { return weight.at(site) * texture.at(site, color); }
  bool varies() const { return texture.given() || weight.varies(); }
};

/// Sums: mixes are layers whose weights add up to 1.
struct ShaderLayers {
  std::vector<ReflectingLayer> reflecting{};
  std::vector<ColorLayer> transparent{}, glowing{};
};

/// f is the weighted sum of the layers', and samples are drawn from one of them, with a probability of its weight times
/// its mean albedo: value, density and sample are those of one material. With T, the brightest channel of what is let
/// through, and W, the sum of the other weights, a ray meets the surface with probability W / (W + T) - what is there
/// is as much brighter, and what passes is changed to have the colour and the mean that the layers give it. Where white
/// is mixed in, W + T is 1, and what passes is not changed. There are no proposal lobes: `product` is `mis` here.
std::shared_ptr<const Material> make_layered_material(ShaderLayers layers);

}  // namespace velour

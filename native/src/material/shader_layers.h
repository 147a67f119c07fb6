// Materials mixed and added from reflecting, transparent and emissive layers.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "material/material.h"
#include "material/principled/principled_point.h"
#include "material/texture_slot.h"

namespace velour {

/// One factor of a layer's weight.
struct LayerFactor {
  /// share: factor of a mix, in [0, 1]; rest: 1 minus that; gain: any non-negative number.
  enum class Kind : int { share = 0, rest = 1, gain = 2 };  // values of velour.h
  Kind kind = Kind::share;
  float value = 1;
  TextureSlot<float> texture{};  // replaces `value`

  float at(const SurfaceSite& site) const;
};

/// Product of the factors; 1 if empty.
struct LayerWeight {
  std::vector<LayerFactor> factors{};

  float at(const SurfaceSite& site) const;
  bool varies() const;
};

/// A reflecting layer. The alpha and emission of its material are ignored.
struct ReflectingLayer {
  std::shared_ptr<const Material> material;
  LayerWeight weight{};
  /// Parameters of a coat above the layer. The coat dims it about the surface normal, regardless of a normal map on the
  /// material.
  std::optional<PrincipledParameters> coated{};
};

/// A transparent layer with a color, or an emissive layer with a radiance.
struct ColorLayer {
  Rgb color{1.0f};
  TextureSlot<Rgb> texture{};
  LayerWeight weight{};

  Rgb at(const SurfaceSite& site) const { return weight.at(site) * texture.at(site, color); }
  bool varies() const { return texture.given() || weight.varies(); }
};

/// A sum of layers; the weights of a mix add up to 1.
struct ShaderLayers {
  std::vector<ReflectingLayer> reflecting{};
  std::vector<ColorLayer> transparent{}, emissive{};
};

/// f is the weighted sum of the layers' f. Samples come from one layer, with a probability proportional to its weight
/// times its mean albedo; value, density and sample describe the whole material. Let T be the brightest channel of the
/// transmitted color and W the sum of the other weights. A ray meets the surface with probability W / (W + T); f and
/// emission are brightened accordingly, and passing light is scaled to the color and mean that the layers give it. In a
/// mix with white, W + T is 1 and passing light is unchanged. There are no proposal lobes: `product` acts as `mis`.
std::shared_ptr<const Material> make_layered_material(ShaderLayers layers);

}  // namespace velour

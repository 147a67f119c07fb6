// Materials mixed and added from reflecting, transparent and emissive layers.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "material/material.h"
#include "material/normal_map.h"
#include "material/principled/principled_material.h"
#include "material/texture.h"

namespace velour {

/// Where a layer of a sequence is: its share is 1 at `peak` and falls linearly to 0 at its neighbors' peaks. The first
/// has begin == peak, the last end == peak; their share is 1 beyond. All shares of a sequence add up to 1.
struct LayerLevel {
  float begin = 0, peak = 0, end = 0;

  float share(float at) const;
};

/// One factor of a layer's weight.
struct LayerFactor {
  /// share: factor of a mix, in [0, 1]; rest: 1 minus that; gain: any number, below 0 only for emission; level: the
  /// share of `level`.
  enum class Kind : int { share = 0, rest = 1, gain = 2, level = 4 };  // values of velour.h
  Kind kind = Kind::share;
  float value = 1;
  TextureSlot<float> texture{};  // replaces `value`
  LayerLevel level{};

  float at(const SurfaceSite& site) const;
};

/// A color, in the working space.
struct LayerTint {
  Rgb color{1.0f};
  TextureSlot<Rgb> texture{};  // replaces `color`

  Rgb at(const SurfaceSite& site) const { return texture.at(site, color); }
};

/// How much of a layer there is, and what colors its light.
struct LayerWeight {
  std::vector<LayerFactor> factors{};
  std::vector<LayerTint> tints{};

  float at(const SurfaceSite& site) const;  // product of the factors; 1 if there are none
  Rgb tint(const SurfaceSite& site) const;  // product of the tints; they let no light through
  bool varies() const;
};

/// Sheen and a coat above other layers, each about its own normal.
struct PrincipledTop {
  PrincipledParameters parameters{};
  PrincipledTextures textures{};
  std::optional<NormalMap> normal{}, coat_normal{};  // none: that of the surface

  /// Share of the light that passes.
  Rgb through(const Vec3& wv, const SurfaceSite& site, const LobeFilter& filter) const;
};

/// A reflecting layer: any material, measured ones and further mixes included. The alpha and emission of its material
/// are ignored.
struct ReflectingLayer {
  std::shared_ptr<const Material> material;
  LayerWeight weight{};
  std::optional<PrincipledTop> top{};  // dims the layer
  bool rec709_colors = false;  // f is Rec. 709 (measured) and is converted to the working space; false: already there
  /// The material has no normals of its own, so that views below the horizon, which SurfaceMaterial::turned passes on,
  /// are moved up to it (above_horizon()).
  bool lifts_views = false;
};

/// A transparent layer with a color, or an emissive layer with a radiance.
struct ColorLayer {
  Rgb color{1.0f};
  TextureSlot<Rgb> texture{};
  LayerWeight weight{};

  Rgb at(const SurfaceSite& site) const { return weight.at(site) * texture.at(site, color) * weight.tint(site); }
  bool varies() const { return texture.given() || weight.varies(); }
};

/// A sum of layers; the weights of a mix add up to 1.
struct ShaderLayers {
  std::vector<ReflectingLayer> reflecting{};
  std::vector<ColorLayer> transparent{}, emissive{};
  std::optional<Mat3> rec709_to_working{};  // none: the working space is Rec. 709
};

/// f is the sum of the layers' f, weighted and tinted. Samples come from one layer, with a probability proportional to
/// its weight times its mean albedo; value, density and sample describe the whole material. It transmits light if a
/// layer does; samples of the others then have no direction below the horizon. Let T be the brightest channel of the
/// transmitted color and W the sum of the other weights. A ray meets the surface with probability W / (W + T); f and
/// emission are brightened accordingly, and passing light is scaled to the color and mean that the layers give it. In a
/// mix with white, W + T is 1 and passing light is unchanged. There are proposal lobes where all layers have some, as
/// measured ones do; otherwise `product` acts as `mis`.
std::shared_ptr<const Material> make_layered_material(ShaderLayers layers);

}  // namespace velour

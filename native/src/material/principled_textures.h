// Principled materials whose parameters are pictures.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/principled_lobes.h"
#include "material/texture.h"
#include "material/texture_map.h"

namespace velour {

/// A picture in the place of a parameter; without one the parameter's own value holds.
template <class T>
struct TextureSlot {
  std::shared_ptr<const Texture<T>> texture{};
  TextureMap map{};  // of the surface's coordinates to the picture's

  T at(const SurfaceSite& site, const T& otherwise) const {
    return texture ? texture->look_up(map.point(site.uv), map.map * site.footprint) : otherwise;
  }
};

struct PrincipledTextures {
  TextureSlot<Rgb> base_color{};
  TextureSlot<float> metallic{}, roughness{}, alpha{};

  bool any() const { return base_color.texture || metallic.texture || roughness.texture || alpha.texture; }
};

/// Parameters are averaged over the footprint, each by itself: exact for the base colour of what is far away, while the
/// mean of rough and smooth is shown as one roughness between them. `alpha` holds where it has no texture.
std::shared_ptr<const Material> make_textured_material(const PrincipledParameters& parameters,
                                                       const PrincipledTextures& textures, float alpha);

}  // namespace velour

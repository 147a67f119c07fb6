// Principled materials that get their parameters from textures.
#pragma once

#include "material/principled/principled_material.h"

namespace velour::test {

template <class T>
TextureSlot<T> one_texel(const T& value) {
  return {std::make_shared<const Texture<T>>(1, 1, std::vector<T>{value}, TextureOptions{}), {}};
}

/// The material of `p` whose base color, metallic and roughness come from textures of one texel.
inline std::shared_ptr<const Material> textured(const PrincipledParameters& p) {
  PrincipledParameters other = p;
  other.base_color = Rgb(0.123f);
  other.metallic = 0.77f;
  other.roughness = 0.66f;
  return make_principled_material(other, {one_texel(p.base_color), one_texel(p.metallic), one_texel(p.roughness), {}});
}

}  // namespace velour::test

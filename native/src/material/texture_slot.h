// A picture in the place of a number or a colour of a material.
#pragma once

#include <memory>

#include "material/surface_site.h"
#include "material/texture.h"
#include "material/texture_map.h"

namespace velour {

/// Without a picture the parameter's own value holds.
template <class T>
struct TextureSlot {
  std::shared_ptr<const Texture<T>> texture;
  TextureMap map;  // of the surface's coordinates to the picture's
  size_t set;      // which of them (SurfaceSite::place)

  // Not an aggregate: of those in braced lists GCC 12 warns of members that were not initialised.
  TextureSlot(std::shared_ptr<const Texture<T>> picture = nullptr, const TextureMap& to_picture = {},
              size_t of_surface = 0) noexcept
      : texture(std::move(picture)), map(to_picture), set(of_surface) {}

  T at(const SurfaceSite& site, const T& otherwise) const {
    if (!texture) return otherwise;
    const SitePlace place = site.place(set);
    return texture->look_up(map.point(place.uv), map.map * place.footprint);
  }
};

}  // namespace velour

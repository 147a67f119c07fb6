// Materials with texture coordinates of their own.
#pragma once

#include <memory>

#include "material/material.h"
#include "material/texture_slot.h"

namespace velour {

/// `material` on the texture coordinates `map` (u, v), to which the surface's are mapped, and turned with them about
/// the normal: its +x is the direction in which its own u grows. Assumes that the surface's u and v grow at right
/// angles and equally fast, as in most unwrapped meshes. `map` must be invertible. Returns `material` itself where this
/// changes nothing.
std::shared_ptr<const Material> make_placed(std::shared_ptr<const Material> material, const TextureMap& map);

}  // namespace velour

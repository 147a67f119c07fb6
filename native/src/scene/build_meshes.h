// Many meshes at once.
#pragma once

#include <span>
#include <vector>

#include "scene/mesh.h"

namespace velour {

/// Of each its Mesh, built side by side.
std::vector<Mesh> build_meshes(std::span<const MeshArrays> arrays);

}  // namespace velour

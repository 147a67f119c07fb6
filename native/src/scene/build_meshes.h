// Builds many meshes at once.
#pragma once

#include <span>
#include <vector>

#include "scene/mesh.h"

namespace velour {

/// Builds a Mesh from each entry of `arrays`, in parallel.
std::vector<Mesh> build_meshes(std::span<const MeshArrays> arrays);

}  // namespace velour

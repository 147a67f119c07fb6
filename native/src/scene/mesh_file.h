// Reads meshes from files of any supported format.
#pragma once

#include <span>
#include <string>
#include <vector>
#include "scene/mesh.h"

namespace velour {

/// Reads PLY if the extension is .ply (in any case), else Wavefront OBJ. Throws Error with the file's name.
Mesh read_mesh(const std::string& path);

// Builds many meshes at once.

/// Builds a Mesh from each entry of `arrays`, in parallel.
std::vector<Mesh> build_meshes(std::span<const MeshArrays> arrays);

}  // namespace velour

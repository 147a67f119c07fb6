// Meshes from files, whatever their format.
#pragma once

#include <string>

#include "scene/mesh.h"

namespace velour {

/// PLY by the extension .ply (any case), Wavefront OBJ otherwise. Throws Error with the file's name.
Mesh read_mesh(const std::string& path);

}  // namespace velour

// Reads meshes from files of any supported format.
#pragma once

#include <string>

#include "scene/mesh.h"

namespace velour {

/// Reads PLY if the extension is .ply (in any case), else Wavefront OBJ. Throws Error with the file's name.
Mesh read_mesh(const std::string& path);

}  // namespace velour

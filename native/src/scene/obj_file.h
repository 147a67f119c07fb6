// Wavefront OBJ.
#pragma once

#include <string>

#include "scene/mesh.h"

namespace velour {

/// All shapes of the file as one mesh; polygons are cut into triangles, material libraries are not read.
/// Throws Error with the file's name.
Mesh read_obj(const std::string& path);

}  // namespace velour

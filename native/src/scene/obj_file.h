// Wavefront OBJ.
#pragma once

#include <string>

#include "scene/mesh.h"

namespace velour {

/// All shapes of the file as one mesh. Polygons are cut into triangles; each face keeps the normals and texture
/// coordinates that it names. A face without normals is smooth in a smoothing group of a file that has no normals, else
/// flat, as in Blender's importer. Materials, curves and points are not read. Notes: faces that lack what others have.
/// Throws Error(io, bad_data) with the file's name and the line at fault.
Mesh read_obj(const std::string& path);

}  // namespace velour

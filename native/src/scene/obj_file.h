// Wavefront OBJ files.
#pragma once

#include <string>

#include "scene/mesh.h"

namespace velour {

/// Reads all shapes of the file as one mesh. Polygons are cut into triangles; each face keeps the normals and texture
/// coordinates that it names. As in Blender's importer, a face without normals is smooth if the file has no normals and
/// the face is in a smoothing group, else flat. Materials, curves and points are not read. The mesh's notes count faces
/// without the normals or texture coordinates that others have. Throws Error(io, bad_data) with the file's name and the
/// line at fault.
Mesh read_obj(const std::string& path);

}  // namespace velour

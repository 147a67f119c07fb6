// Stanford PLY: ascii, and binary of both byte orders.
#pragma once

#include <string>

#include "scene/mesh.h"

namespace velour {

/// Vertices by x, y, z, with normals (nx, ny, nz) and texture coordinates (s, t or u, v) where it has them; polygons by
/// vertex_indices or vertex_index, cut into triangles, with texture coordinates of corners (texcoord) where they have
/// them. Elements come in any order; others, and other properties, are skipped.
/// Throws Error(io, bad_data) with the file's name; never reads or allocates more than the file's size asks for.
Mesh read_ply(const std::string& path);

}  // namespace velour

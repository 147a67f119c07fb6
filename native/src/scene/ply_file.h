// Stanford PLY files, ASCII and binary in both byte orders.
#pragma once

#include <string>

#include "scene/mesh.h"

namespace velour {

/// Reads vertices (x, y, z), with normals (nx, ny, nz) and texture coordinates (s, t or u, v) if present, and polygons
/// (vertex_indices or vertex_index), cut into triangles, with texture coordinates of corners (texcoord) if present.
/// Elements may come in any order; other elements and properties are skipped.
/// Throws Error(io, bad_data) with the file's name; never reads or allocates more than the file's size justifies.
Mesh read_ply(const std::string& path);

}  // namespace velour

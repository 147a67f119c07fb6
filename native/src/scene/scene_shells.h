// The surface that rays hit in place of a mesh whose materials have shells (VOTF).
#pragma once

#include <limits>
#include <map>
#include <vector>

#include "scene/embree_scene.h"
#include "scene/mesh.h"

namespace velour {

/// Folds of a shell over itself, where its height or depth exceeds the surface's radius of curvature.
struct ShellFolds {
  uint64_t triangles = 0, all = 0;
  float least_radius = std::numeric_limits<float>::infinity();  // of curvature on those triangles, meters

  /// Adds a triangle: corners in world space, unit normals, and the extent of the shell over it.
  void add(const Vec3 (&corner)[3], const Vec3 (&normal)[3], const ShellHeights& shell);
};

struct ShellTop {
  Mesh mesh;
  std::vector<ShellFolds> folds;  // per slot
  uint32_t number = kNoHit;       // in the hierarchy; kNoHit: not there
  bool is_shown = true;
};

/// Keyed by everything that a top depends on, the mesh's number first. Addresses of tops stay valid.
using ShellTops = std::map<std::vector<uint32_t>, ShellTop>;

}  // namespace velour

// The surface that rays meet of a mesh whose materials have shells (VOTF).
#pragma once

#include <limits>
#include <map>
#include <vector>

#include "scene/embree_scene.h"
#include "scene/mesh.h"

namespace velour {

/// Where a shell folds over itself: its height or depth exceeds the radius with which the surface bends there.
struct ShellFolds {
  uint64_t triangles = 0, all = 0;
  float least_radius = std::numeric_limits<float>::infinity();  // metres, of those triangles

  /// A triangle in the world, unit normals, and from where to where the shell reaches over it.
  void add(const Vec3 (&corner)[3], const Vec3 (&normal)[3], const ShellHeights& shell);
};

struct ShellTop {
  Mesh mesh;
  std::vector<ShellFolds> folds;  // of each slot
  uint32_t number = kNoHit;       // in the hierarchy; kNoHit: it is not there
  bool is_shown = true;
};

/// By all that they depend on, of which the mesh's number is the first. Their places in memory stay.
using ShellTops = std::map<std::vector<uint32_t>, ShellTop>;

}  // namespace velour

// What tests ask of the mesh of a tile.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>
#include <utility>
#include <vector>

#include "capture/tile/tile.h"

namespace velour {

/// What GoogleTest prints of a parameter.
inline void PrintTo(const TileKind& kind, std::ostream* out) { *out << kind.name; }

}  // namespace velour

namespace velour::testing {

inline Vec3d corner(const TileMesh& mesh, size_t triangle, int k) {
  return Vec3d(mesh.positions[mesh.triangles[triangle][k]]);
}

/// Twice the area times the unit normal.
inline Vec3d area_normal(const TileMesh& mesh, size_t triangle) {
  const Vec3d a = corner(mesh, triangle, 0);
  return glm::cross(corner(mesh, triangle, 1) - a, corner(mesh, triangle, 2) - a);
}

/// What the surface encloses, or lies under it down to z = 0: the flux of (0, 0, z), which does not enter by the open
/// ends of yarns. `slot`: of that slot alone.
inline double volume(const TileMesh& mesh, const std::vector<uint32_t>& slots) {
  double sum = 0;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (std::find(slots.begin(), slots.end(), mesh.slots[i]) == slots.end()) continue;
    sum += area_normal(mesh, i).z * (corner(mesh, i, 0).z + corner(mesh, i, 1).z + corner(mesh, i, 2).z) / 6;
  }
  return sum;
}

inline double area(const TileMesh& mesh, const std::vector<uint32_t>& slots) {
  double sum = 0;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (std::find(slots.begin(), slots.end(), mesh.slots[i]) == slots.end()) continue;
    sum += 0.5 * glm::length(area_normal(mesh, i));
  }
  return sum;
}

/// Area of a regular polygon of `n` corners in a unit circle.
inline double polygon_area(int n) { return 0.5 * n * std::sin(2 * kPiD / n); }

/// A corner of a triangle: its vertex, and where its normal stands.
struct EdgeEnd {
  uint32_t vertex;
  size_t corner;
};
struct Edge {
  EdgeEnd from, to;
};

/// Edges that only one triangle has, and how many are walked twice in one direction (no surface with two sides).
struct Edges {
  std::vector<Edge> border;
  size_t walked_twice = 0;
};
inline Edges edges(const TileMesh& mesh) {
  Edges found;
  std::map<std::pair<uint32_t, uint32_t>, Edge> walked;
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3;
      const EdgeEnd from{mesh.triangles[i][k], 3 * i + static_cast<size_t>(k)};
      const EdgeEnd to{mesh.triangles[i][next], 3 * i + static_cast<size_t>(next)};
      if (!walked.emplace(std::pair(from.vertex, to.vertex), Edge{from, to}).second) ++found.walked_twice;
    }
  }
  for (const auto& [key, edge] : walked) {
    if (!walked.contains({key.second, key.first})) found.border.push_back(edge);
  }
  return found;
}

}  // namespace velour::testing

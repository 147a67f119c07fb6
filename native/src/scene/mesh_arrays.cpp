#include "scene/mesh_arrays.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "job/error.h"
#include "job/parallel.h"

namespace velour {
namespace {

/// Embree's own bound on coordinates, beyond which triangles vanish silently.
constexpr float kReach = 1.8e18f;

void check_length(size_t found, size_t expected, const char* what) {
  if (found == 0 || found == expected) return;
  refuse("A mesh has " + std::to_string(found) + " " + what + ", but its triangles require " +
         std::to_string(expected) + ".");
}

/// `more`: number of coordinates in all further sets; `first`: in the first set.
void check_more_uvs(size_t more, size_t first) {
  if (more == 0 || (first > 0 && more % first == 0)) return;
  refuse("A mesh has " + std::to_string(more) +
         " texture coordinates in further UV sets; the number must be a multiple of the " + std::to_string(first) +
         " in its first UV set.");
}

/// Error message if a triangle names a missing corner or vertex.
std::optional<std::string> missing(const MeshArrays& arrays, size_t triangle) {
  const auto lacks = [&](const char* what, size_t number, size_t count, const char* plural) {
    return "Triangle " + std::to_string(triangle) + " has " + what + " index " + std::to_string(number) +
           ", but the mesh has only " + std::to_string(count) + " " + plural + ".";
  };
  for (int k = 0; k < 3; ++k) {
    uint32_t vertex = arrays.triangles[triangle][k];
    if (!arrays.corner_vertices.empty()) {
      if (vertex >= arrays.corner_vertices.size())
        return lacks("corner", vertex, arrays.corner_vertices.size(), "corners");
      vertex = arrays.corner_vertices[vertex];
    }
    if (vertex >= arrays.positions.size()) return lacks("vertex", vertex, arrays.positions.size(), "vertices");
  }
  return std::nullopt;
}

bool usable(const MeshArrays& arrays, size_t triangle) {
  const glm::uvec3& t = arrays.triangles[triangle];
  const auto position = [&](int k) {
    return arrays.positions[arrays.corner_vertices.empty() ? t[k] : arrays.corner_vertices[t[k]]];
  };
  const Vec3 a = position(0), b = position(1), c = position(2);
  return usable_position(a) && usable_position(b) && usable_position(c) && glm::length(area_normal(a, b, c)) > 0.0;
}

}  // namespace

bool usable_position(const Vec3& p) {
  return std::abs(p.x) < kReach && std::abs(p.y) < kReach && std::abs(p.z) < kReach;  // false for NaN
}

Vec3d area_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return glm::cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
}

void MeshArrays::check() const {
  const size_t n = triangles.size(), corners = this->corners();
  check_length(corner_normals.size(), corners, "corner normals");
  check_length(corner_uvs.size(), corners, "corner texture coordinates");
  check_more_uvs(more_uvs.size(), corner_uvs.size());
  check_length(relief_uvs.size(), corners, "texture coordinates of normal maps");
  if (corners == 0 ? !corner_colors.empty() : corner_colors.size() % corners != 0) {
    refuse("A mesh has " + std::to_string(corner_colors.size()) +
           " corner colors; the number must be a multiple of its " + std::to_string(corners) + " corners.");
  }
  check_length(material_slots.size(), n, "material slots");
  check_length(smooth.size(), n, "smooth flags");
  check_length(vertex_normals.size(), positions.size(), "vertex normals");
}

Vec3 MeshArrays::normal(size_t triangle, int k, uint32_t vertex) const {
  if (!corner_normals.empty()) return corner_normals[corner(triangle, k)];
  return vertex_normals.empty() || !is_smooth(triangle) ? Vec3(0.0f) : vertex_normals[vertex];
}

std::vector<uint32_t> usable_triangles(const MeshArrays& arrays) {
  const size_t n = arrays.triangles.size(), pieces = (n + kTrianglesOfPiece - 1) / kTrianglesOfPiece;
  std::vector<std::vector<uint32_t>> kept(pieces);
  std::vector<std::optional<std::string>> wrong(pieces);
  const Progress unwatched;
  parallel_pieces(pieces, 0, unwatched, [&](size_t piece) {
    const size_t begin = piece * kTrianglesOfPiece, end = std::min(begin + kTrianglesOfPiece, n);
    kept[piece].reserve(end - begin);
    for (size_t i = begin; i < end && !wrong[piece]; ++i) {
      wrong[piece] = missing(arrays, i);
      if (!wrong[piece] && usable(arrays, i)) kept[piece].push_back(static_cast<uint32_t>(i));
    }
  });
  for (const auto& sentence : wrong) {
    if (sentence) refuse(*sentence);
  }
  if (pieces == 1) return std::move(kept[0]);
  std::vector<uint32_t> all;
  all.reserve(n);
  for (const std::vector<uint32_t>& piece : kept) all.insert(all.end(), piece.begin(), piece.end());
  return all;
}

}  // namespace velour

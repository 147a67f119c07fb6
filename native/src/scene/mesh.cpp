#include "scene/mesh.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "job/error.h"

namespace velour {
namespace {

/// Embree's own bound on coordinates; beyond it triangles vanish silently.
constexpr float kReach = 1.8e18f;

bool usable(const Vec3& p) {
  return std::abs(p.x) < kReach && std::abs(p.y) < kReach && std::abs(p.z) < kReach;  // false for NaN
}

/// Twice the area times the unit normal, in float64: edges of tiny and huge meshes neither vanish nor overflow.
Vec3d area_normal(const Vec3& a, const Vec3& b, const Vec3& c) {
  return glm::cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a));
}

Vec3 unit(const Vec3d& v) { return Vec3(v / glm::length(v)); }

/// A direction that can be normalised in float32.
bool usable_normal(const Vec3& n) {
  const float length_sq = glm::dot(n, n);
  return length_sq > 1e-30f && std::isfinite(length_sq);
}

void check_length(size_t found, size_t expected, const char* what) {
  if (found == 0 || found == expected) return;
  throw Error(Status::invalid_argument, "A mesh has " + std::to_string(found) + " " + what +
                                            " where its triangles need " + std::to_string(expected) + ".");
}

}  // namespace

Mesh::Mesh(const MeshArrays& arrays) {
  const size_t n = arrays.triangles.size();
  check_length(arrays.corner_normals.size(), 3 * n, "corner normals");
  check_length(arrays.corner_uvs.size(), 3 * n, "corner texture coordinates");
  check_length(arrays.material_slots.size(), n, "material slots");
  check_length(arrays.smooth.size(), n, "smooth flags");
  positions_.assign(arrays.positions.begin(), arrays.positions.end());
  keep_good_triangles(arrays);
}

void Mesh::keep_good_triangles(const MeshArrays& arrays) {
  std::vector<uint8_t> smooth;
  for (size_t i = 0; i < arrays.triangles.size(); ++i) {
    const glm::uvec3& t = arrays.triangles[i];
    const uint32_t last = std::max({t.x, t.y, t.z});
    if (last >= positions_.size()) {
      throw Error(Status::invalid_argument, "Triangle " + std::to_string(i) + " names vertex " + std::to_string(last) +
                                                " of a mesh with " + std::to_string(positions_.size()) + " vertices.");
    }
    const Vec3 &a = positions_[t.x], &b = positions_[t.y], &c = positions_[t.z];
    if (!usable(a) || !usable(b) || !usable(c) || !(glm::length(area_normal(a, b, c)) > 0.0)) {
      ++dropped_;
      continue;
    }
    triangles_.push_back(t);
    if (!arrays.smooth.empty()) smooth.push_back(arrays.smooth[i]);
    if (!arrays.material_slots.empty()) slots_.push_back(arrays.material_slots[i]);
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
      if (!arrays.corner_normals.empty()) normals_.push_back(arrays.corner_normals[k]);
      if (!arrays.corner_uvs.empty()) uvs_.push_back(arrays.corner_uvs[k]);
    }
  }
  // What no triangle names may hold anything; the ray tracer must not see it.
  for (Vec3& p : positions_) {
    if (!usable(p)) p = Vec3(0.0f);
  }
  compute_normals(smooth);
}

void Mesh::compute_normals(std::span<const uint8_t> smooth) {
  std::vector<Vec3d> sums;
  if (normals_.empty()) {
    sums.assign(positions_.size(), Vec3d(0.0));
    for (const glm::uvec3& t : triangles_) {
      const Vec3d n = area_normal(positions_[t.x], positions_[t.y], positions_[t.z]);
      for (int k = 0; k < 3; ++k) sums[t[k]] += n;
    }
  }
  normals_.resize(3 * triangles_.size(), Vec3(0.0f));
  for (size_t i = 0; i < triangles_.size(); ++i) {
    const glm::uvec3& t = triangles_[i];
    const Vec3 flat = unit(area_normal(positions_[t.x], positions_[t.y], positions_[t.z]));
    for (int k = 0; k < 3; ++k) {
      Vec3& n = normals_[3 * i + static_cast<size_t>(k)];
      if (!sums.empty() && (smooth.empty() || smooth[i] != 0) && glm::length(sums[t[k]]) > 0.0) n = unit(sums[t[k]]);
      n = usable_normal(n) ? glm::normalize(n) : flat;
    }
  }
}

namespace {

template <typename T>
T interpolate(const T& a, const T& b, const T& c, const Vec2& uv) {
  return (1.0f - uv.x - uv.y) * a + uv.x * b + uv.y * c;
}

}  // namespace

Vec3 Mesh::position(uint32_t triangle, const Vec2& uv) const {
  const glm::uvec3& t = triangles_[triangle];
  return interpolate(positions_[t.x], positions_[t.y], positions_[t.z], uv);
}

Vec3 Mesh::position_magnitude(uint32_t triangle, const Vec2& uv) const {
  const glm::uvec3& t = triangles_[triangle];
  return interpolate(glm::abs(positions_[t.x]), glm::abs(positions_[t.y]), glm::abs(positions_[t.z]), uv);
}

Vec3 Mesh::shading_normal(uint32_t triangle, const Vec2& uv) const {
  const Vec3* n = &normals_[3 * static_cast<size_t>(triangle)];
  const Vec3 mean = interpolate(n[0], n[1], n[2], uv);
  return usable_normal(mean) ? mean : n[0];  // opposed corner normals cancel
}

Vec3 Mesh::tangent(uint32_t triangle, const Mat2& map) const {
  if (uvs_.empty()) return Vec3(0.0f);
  const glm::uvec3& t = triangles_[triangle];
  const Vec2* uv = &uvs_[3 * static_cast<size_t>(triangle)];
  const Vec3 e1 = positions_[t.y] - positions_[t.x], e2 = positions_[t.z] - positions_[t.x];
  const Vec2 d1 = map * (uv[1] - uv[0]), d2 = map * (uv[2] - uv[0]);
  const float determinant = d1.x * d2.y - d1.y * d2.x;
  const Vec3 along = (d2.y * e1 - d1.y * e2) * (determinant < 0.0f ? -1.0f : 1.0f);
  return determinant != 0.0f && usable_normal(along) ? along : Vec3(0.0f);
}

void Mesh::make_tangents() {
  if (uvs_.empty() || has_tangents()) return;
  tangents_ = corner_tangents(positions_, triangles_, normals_, uvs_);
}

Mat3 Mesh::relief(uint32_t triangle, const Vec2& uv) const {
  const CornerTangent* t = &tangents_[3 * static_cast<size_t>(triangle)];
  const Vec3 normal = shading_normal(triangle, uv);
  const Vec3 tangent = interpolate(t[0].direction, t[1].direction, t[2].direction, uv);
  return {tangent, t[0].side * glm::cross(normal, tangent), normal};
}

uint64_t Mesh::bytes() const {
  return positions_.size() * sizeof(Vec3) + triangles_.size() * sizeof(glm::uvec3) + normals_.size() * sizeof(Vec3) +
         uvs_.size() * sizeof(Vec2) + slots_.size() * sizeof(uint32_t) + tangents_.size() * sizeof(CornerTangent) +
         sides_.size() * sizeof(BorderEdge);
}

}  // namespace velour

// Interpolation between the directions of a set: barycentric on their triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// The Delaunay triangles of directions of one hemisphere (z > 0), found in the stereographic plane, which keeps
/// circles circles: they are those of the sphere. Directions outside all triangles - beyond the last ring - get the
/// weights of the nearest point of the set's outline, so that weights are continuous everywhere. Immutable.
class DirectionMesh {
 public:
  /// Directions with z > 0, all different. One direction, two, or all on a line work: weights are then those of the
  /// nearest point of the line.
  explicit DirectionMesh(std::span<const Vec3> directions);

  struct Weights {
    std::array<uint32_t, 3> index{0, 0, 0};  // of the set
    std::array<float, 3> weight{1, 0, 0};    // in [0, 1], sum 1
  };
  /// `direction.z` may be 0 or less: taken as if on the horizon.
  Weights at(const Vec3& direction) const;

  size_t triangles() const { return triangles_.size(); }

 private:
  using Triangle = std::array<uint32_t, 3>;  // counter-clockwise in the plane
  void triangulate();
  void find_outline();
  void fill_grid();
  /// A triangle with all that a look asks of it.
  struct Corners {
    std::array<glm::dvec2, 3> point;
    Triangle index;
    double whole = 0;  // twice the area
  };
  static int cell_of(double x);
  /// `weight`: times `whole`.
  static bool inside(const Corners& triangle, const glm::dvec2& p, std::array<double, 3>& weight);
  Weights on_outline(const glm::dvec2& p) const;

  static constexpr int kGrid = 64;  // cells along a side of the plane's square [-1, 1]^2
  std::vector<glm::dvec2> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<uint32_t, 2>> outline_;  // edges
  std::vector<Corners> corners_;                  // of the triangles
  std::vector<uint32_t> first_, meeting_;         // triangles that meet a cell, [first_[cell], first_[cell + 1])
};

}  // namespace velour

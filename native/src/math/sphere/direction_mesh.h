// Barycentric interpolation between the directions of a set, on their triangulation.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/sphere/vec.h"

namespace velour {

/// Delaunay triangulation of directions of one hemisphere (z > 0). The stereographic projection maps circles to
/// circles, so triangles found in its plane are those of the sphere. Directions outside all triangles (beyond the last
/// ring) get the weights of the nearest point of the outline, so weights are continuous everywhere. Immutable.
class DirectionMesh {
 public:
  /// `directions` have z > 0 and are distinct. One direction, two, or collinear ones are allowed: weights are then
  /// those of the nearest point of the line.
  explicit DirectionMesh(std::span<const Vec3> directions);

  struct Weights {
    std::array<uint32_t, 3> index{0, 0, 0};  // into the set
    std::array<float, 3> weight{1, 0, 0};    // in [0, 1], sum 1
  };
  /// A `direction` with z <= 0 is treated as if it were on the horizon.
  Weights at(const Vec3& direction) const;

  size_t triangles() const { return triangles_.size(); }

 private:
  using Triangle = std::array<uint32_t, 3>;  // counter-clockwise in the plane
  void triangulate();
  void find_outline();
  void fill_grid();
  /// A triangle with the data that look-ups need.
  struct Corners {
    std::array<glm::dvec2, 3> point;
    Triangle index;
    double whole = 0;  // twice the area
  };
  static int cell_of(double x);
  /// Sets `weight` to the barycentric coordinates times `whole`.
  static bool inside(const Corners& triangle, const glm::dvec2& p, std::array<double, 3>& weight);
  Weights on_outline(const glm::dvec2& p) const;

  static constexpr int kGrid = 64;  // cells along a side of the plane's square [-1, 1]^2
  std::vector<glm::dvec2> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<uint32_t, 2>> outline_;  // edges
  std::vector<Corners> corners_;                  // one per triangle
  std::vector<uint32_t> first_, meeting_;         // triangles that meet a cell, [first_[cell], first_[cell + 1])
};

}  // namespace velour

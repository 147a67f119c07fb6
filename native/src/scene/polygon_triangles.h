// Polygons of mesh files, cut into triangles.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Cuts simple polygons, convex or not, into count - 2 triangles by ear clipping (Meisters 1975) in the plane of the
/// polygon's normal (Newell). The result does not depend on where the origin is or which corner is the first, up to the
/// choice of diagonals. Polygons that cross themselves give some triangles, too. Holds memory between calls.
class PolygonTriangles {
 public:
  /// More corners would take too long: the time grows with the square of their number.
  static constexpr size_t kMaxCorners = 20000;

  /// The positions of the polygon's corners, in order; at least 3 and at most kMaxCorners. Returns corners by their
  /// place in `corners`, valid until the next call.
  std::span<const glm::uvec3> cut(std::span<const Vec3> corners);

 private:
  void project(std::span<const Vec3> corners);
  void cut_quad();
  void clip_ears();
  double turn(uint32_t a, uint32_t b, uint32_t c) const;
  bool is_ear(uint32_t corner) const;

  std::vector<glm::dvec2> points_;  // counterclockwise
  std::vector<uint32_t> next_, previous_;
  std::vector<glm::uvec3> triangles_;
};

}  // namespace velour

#include "capture/tile/chainmail.h"

#include <cmath>

#include "capture/tile/mesh_builder.h"

namespace velour {

Ring ring_at(const TileShape& shape, int column, int row) {
  const bool odd = row % 2 != 0;
  const double lean = odd ? -kRingLean : kRingLean, c = std::cos(lean), s = std::sin(lean);
  const Vec3d center(column + (odd ? 0.75 : 0.25), row + 0.5, 0);
  return {.center = shape.pitch() * center,
          .side = {c, 0, -s},
          .along = {0, 1, 0},
          .axis = {s, 0, c},
          .radius = kRingRadius * shape.pitch()};
}

TileParts make_chainmail(const TileShape& shape) {
  const double wire = 0.5 * shape.thickness * shape.pitch();
  // Makes the quads of the wire's surface about square: the ring is longer than the wire's circumference by this
  // factor.
  const int cells_along = static_cast<int>(std::ceil(shape.resolution * kRingRadius / shape.thickness));
  const MeshBuilder::Grid grid{.cells_u = cells_along,
                               .cells_v = shape.resolution,
                               .end_u = GridEnd::join(),
                               .end_v = GridEnd::join(),
                               .slot = 0};
  MeshBuilder builder;
  for (int row = 0; row < shape.count; ++row) {
    for (int column = 0; column < shape.count; ++column) {
      const Ring ring = ring_at(shape, column, row);
      builder.add_grid(grid, [&](double u, double v) {
        const double t = 2 * kPiD * u, w = 2 * kPiD * v;
        const Vec3d out = std::cos(t) * ring.side + std::sin(t) * ring.along;
        return ring.center + (ring.radius + wire * std::cos(w)) * out + wire * std::sin(w) * ring.axis;
      });
    }
  }
  return {.mesh = builder.finish(),
          .materials = {{"steel", {.base_color = {0.56f, 0.55f, 0.53f}, .metallic = 1, .roughness = 0.3f}}},
          .open = true};
}

}  // namespace velour

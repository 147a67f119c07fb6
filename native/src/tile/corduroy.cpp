#include "tile/corduroy.h"

#include <cmath>

#include "tile/mesh_builder.h"
#include "tile/periodic_noise.h"

namespace velour {
namespace {

constexpr int kTuftsAcross = 4;  // per pitch
constexpr int kTuftsAlong = 6;   // per pitch

/// Profile across one wale at `t` in [0, 1): x in [0, 1) from the left edge of the rib to that of the next, and height
/// in rib heights. The last step of the grid crosses the groove.
glm::dvec2 wale(double t, double groove_step, double gap) {
  const double angle = kPiD * t / (1 - groove_step);
  const double half_width = 0.5 * (1 - gap);
  const double across = std::cos(std::min(angle, kPiD));  // dense lines where the rib is steep
  return {half_width * (1 - across), 1 - across * across};
}

}  // namespace

TileParts make_corduroy(const TileShape& shape) {
  const double pitch = shape.pitch();
  const int cells = shape.count * shape.resolution;
  const PeriodicNoise tufts{shape.seed, 0, glm::ivec2(kTuftsAcross, kTuftsAlong) * shape.count};
  MeshBuilder builder;
  const MeshBuilder::Grid grid{.cells_u = cells,
                               .cells_v = cells,
                               .end_u = GridEnd::repeat({shape.size, 0, 0}),
                               .end_v = GridEnd::repeat({0, shape.size, 0}),
                               .slot = 0};
  builder.add_grid(grid, [&](double u, double v) {
    const double wales = u * shape.count, number = std::floor(wales + 1e-9);
    const glm::dvec2 profile = wale(wales - number, 1.0 / shape.resolution, shape.gap);
    const double share = 1 - shape.irregularity * tufts({u, v});
    const double x = (number + 0.5 * shape.gap + profile.x) * pitch;
    return Vec3d(x, v * shape.size, shape.thickness * pitch * profile.y * share);
  });
  return {.mesh = builder.finish(),
          .materials = {{"pile", {.base_color = {0.36f, 0.16f, 0.05f}, .roughness = 0.8f, .specular = 0.2f}}},
          .open = false,
          .open_area = 0.0};
}

}  // namespace velour

#include "capture/tile/sheets.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>
#include "capture/tile/mesh_builder.h"
#include "capture/tile/periodic_noise.h"
#include "math/sphere/random.h"

namespace velour {

namespace {

MeshBuilder::Grid sheet(const TileShape& shape) {
  const int cells = shape.count * shape.resolution;
  return {.cells_u = cells,
          .cells_v = cells,
          .end_u = GridEnd::repeat({shape.size, 0, 0}),
          .end_v = GridEnd::repeat({0, shape.size, 0}),
          .slot = 0};
}

TileParts closed_sheet(TileMesh mesh, TileMaterial material) {
  return {.mesh = std::move(mesh), .materials = {std::move(material)}, .open = false, .open_area = 0.0};
}

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
  const PeriodicNoise tufts{shape.seed, 0, glm::ivec2(kTuftsAcross, kTuftsAlong) * shape.count};
  MeshBuilder builder;
  builder.add_grid(sheet(shape), [&](double u, double v) {
    const double wales = u * shape.count, number = std::floor(wales + 1e-9);
    const glm::dvec2 profile = wale(wales - number, 1.0 / shape.resolution, shape.gap);
    const double share = 1 - shape.irregularity * tufts({u, v});
    const double x = (number + 0.5 * shape.gap + profile.x) * pitch;
    return Vec3d(x, v * shape.size, shape.thickness * pitch * profile.y * share);
  });
  return closed_sheet(builder.finish(),
                      {"pile", {.base_color = {0.36f, 0.16f, 0.05f}, .roughness = 0.8f, .specular = 0.2f}});
}

namespace {

constexpr uint64_t kGrainStream = 0x6772;
constexpr double kLowestCushion = 0.5;  // height of the lowest cushion at irregularity 1, in heights of the others

/// Jittered points of a Voronoi diagram that repeats with the tile, in pitches.
class Grain {
 public:
  explicit Grain(const TileShape& shape) : count_(shape.count) {
    for (int i = 0; i < count_ * count_; ++i) {
      RandomStream random(shape.seed, kGrainStream, static_cast<uint64_t>(i));
      const Vec2 jitter = random.next2();
      points_.push_back({glm::mix(glm::dvec2(0.5), glm::dvec2(jitter), shape.irregularity),
                         1 - shape.irregularity * (1 - kLowestCushion) * double(random.next())});
    }
  }

  struct Nearest {
    double border = 0;  // distance from the border of the cell, pitches
    double height = 0;  // of the cell's cushion, relative to the highest
  };
  Nearest at(const glm::dvec2& place) const {
    const glm::ivec2 cell(glm::floor(place));
    glm::dvec2 nearest(0.0);
    double closest = 1e9, height = 0;
    each(cell, [&](const glm::dvec2& point, double cushion) {
      const double distance = glm::length(point - place);
      if (distance < closest) closest = distance, nearest = point, height = cushion;
    });
    double border = 1e9;
    each(cell, [&](const glm::dvec2& point, double) {
      const glm::dvec2 apart = point - nearest;
      const double length = glm::length(apart);
      if (length > 0) border = std::min(border, glm::dot(0.5 * (point + nearest) - place, apart) / length);
    });
    return {border, height};
  }

 private:
  struct Point {
    glm::dvec2 place;  // in its cell
    double height;
  };

  /// Calls for the points of the 5 x 5 cells around `cell`, which hold all that can border on the nearest one.
  template <class Call>
  void each(const glm::ivec2& cell, const Call& call) const {
    for (int y = cell.y - 2; y <= cell.y + 2; ++y) {
      for (int x = cell.x - 2; x <= cell.x + 2; ++x) {
        const int column = ((x % count_) + count_) % count_, row = ((y % count_) + count_) % count_;
        const Point& point = points_[static_cast<size_t>(row * count_ + column)];
        call(glm::dvec2(x, y) + point.place, point.height);
      }
    }
  }

  int count_;
  std::vector<Point> points_;
};

}  // namespace

TileParts make_leather(const TileShape& shape) {
  const Grain grain(shape);
  MeshBuilder builder;
  builder.add_grid(sheet(shape), [&](double u, double v) {
    const Grain::Nearest nearest = grain.at(glm::dvec2(u, v) * double(shape.count));
    const double t = std::min(2 * nearest.border / shape.gap, 1.0);  // from the bottom of the crease to the cushion
    const double z = shape.thickness * shape.pitch() * nearest.height * t * t * (3 - 2 * t);
    return Vec3d(u * shape.size, v * shape.size, z);
  });
  return closed_sheet(builder.finish(), {"leather", {.base_color = {0.16f, 0.06f, 0.025f}, .roughness = 0.4f}});
}

}  // namespace velour

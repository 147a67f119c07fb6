#include "capture/tile/knit.h"

#include <algorithm>
#include <cmath>
#include "capture/tile/mesh_builder.h"
#include "capture/tile/periodic_noise.h"
#include "math/sphere/random.h"

namespace velour {
namespace {

constexpr double kTurn = 2 * kPiD;
constexpr int kPlies = 3;
constexpr int kTwist = 2;            // turns of the plies per loop
constexpr double kPlyDepth = 0.15;   // depth of the grooves between plies, in radii of the yarn
constexpr double kLoopLength = 3.7;  // length of the middle line per loop, wales

/// The middle line of a course, in wales; the loop begins at its head.
Vec3d middle(double t) {
  return {t / kTurn + kLoopWidth * std::sin(2 * t), kLoopHeight * std::cos(t), -kLoopDepth * std::cos(2 * t)};
}

Vec3d tangent(double t) {
  return glm::normalize(Vec3d(1 / kTurn + 2 * kLoopWidth * std::cos(2 * t), -kLoopHeight * std::sin(t),
                              2 * kLoopDepth * std::sin(2 * t)));
}

/// Radius of a yarn of round plies in the direction `angle`, relative to its largest.
double ply_share(double angle) { return 1 - kPlyDepth * (1 - std::abs(std::cos(0.5 * kPlies * angle))); }

}  // namespace

TileParts make_knit(const TileShape& shape) {
  const double wale = shape.pitch(), radius = 0.5 * shape.thickness * wale;
  const int courses = static_cast<int>(std::lround(shape.count / kCourse));
  const int cells_along = static_cast<int>(std::ceil(shape.resolution * kLoopLength / (kPiD * kThickestYarn)));
  const MeshBuilder::Grid grid{.cells_u = shape.count * cells_along,
                               .cells_v = shape.resolution,
                               .end_u = GridEnd::repeat({shape.size, 0, 0}),
                               .end_v = GridEnd::join(),
                               .slot = 0};
  MeshBuilder builder;
  for (int course = 0; course < courses; ++course) {
    const PeriodicNoise noise{shape.seed, static_cast<uint64_t>(course), {3 * shape.count, 1}};
    builder.add_grid(grid, [&](double u, double v) {
      const double t = kTurn * u * shape.count, angle = -kTurn * v;  // clockwise, so that the surface faces outward
      const Vec3d along = tangent(t), side = glm::normalize(glm::cross(Vec3d(0, 0, 1), along));
      const Vec3d out = std::cos(angle) * side + std::sin(angle) * glm::cross(along, side);
      const double share = ply_share(angle - kTwist * t) * (1 - shape.irregularity * noise({u, 0}));
      return wale * (middle(t) + Vec3d(0, (course + 0.5) * kCourse, 0)) + radius * share * out;
    });
  }
  return {.mesh = builder.finish(),
          .materials = {{"yarn", {.base_color = {0.5f, 0.42f, 0.32f}, .roughness = 0.8f, .specular = 0.2f}}},
          .open = true};
}

namespace {

constexpr uint64_t kJitterStream = 0x7665;
constexpr double kJitter = 0.5;        // largest distance of two neighbors from their places, in gaps
constexpr int kLeanSpan = 14;          // pitches over which the lean changes
constexpr double kFurthestLean = 0.5;  // in heights of the pile

}  // namespace

TileParts make_velvet(const TileShape& shape) {
  const double pitch = shape.pitch(), height = shape.thickness * pitch;
  const double radius = std::min(0.5 * (1 - shape.gap) * pitch, 0.5 * height);
  const int areas = std::max(shape.count / kLeanSpan, 1);
  const PeriodicNoise noise_x{shape.seed, 0, glm::ivec2(areas)}, noise_y{shape.seed, 1, glm::ivec2(areas)};
  MeshBuilder builder;
  builder.add_grid({.cells_u = 1,
                    .cells_v = 1,
                    .end_u = GridEnd::repeat({shape.size, 0, 0}),
                    .end_v = GridEnd::repeat({0, shape.size, 0}),
                    .slot = 0},
                   [](double, double) { return Vec3d(0.0); });
  for (int row = 0; row < shape.count; ++row) {
    for (int column = 0; column < shape.count; ++column) {
      const auto number =
          static_cast<uint64_t>(row) * static_cast<uint64_t>(shape.count) + static_cast<uint64_t>(column);
      const glm::dvec2 jitter(RandomStream(shape.seed, kJitterStream, number).next2() - 0.5f);
      const glm::dvec2 place =
          (glm::dvec2(column, row) + 0.5 + kJitter * shape.gap * shape.irregularity * jitter) / double(shape.count);
      const glm::dvec2 lean =
          2 * kFurthestLean * height * shape.irregularity * (glm::dvec2(noise_x(place), noise_y(place)) - 0.5);
      builder.add_globe(shape.resolution, 1, [&](const Vec3d& direction) {
        // A capsule: round ends, between which the ball is drawn out and bent.
        const double up = direction.z;
        const double z = up > 0.5    ? height - radius * (1 - up)
                         : up < -0.5 ? radius * (1 + up)
                                     : glm::mix(0.5 * radius, height - 0.5 * radius, up + 0.5);
        const double bent = (z / height) * (z / height);
        return Vec3d(place * shape.size + lean * bent + radius * glm::dvec2(direction), z);
      });
    }
  }
  return {.mesh = builder.finish(),
          .materials = {{"ground", {.base_color = {0.1f, 0.004f, 0.012f}, .roughness = 0.9f, .specular = 0.2f}},
                        {"pile", {.base_color = {0.32f, 0.01f, 0.035f}, .roughness = 0.35f}}},
          .open = false,
          .open_area = 0.0};
}

}  // namespace velour

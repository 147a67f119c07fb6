#include "capture/tile/bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "capture/tile/mesh_builder.h"
#include "math/sphere/random.h"

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

namespace {

constexpr uint64_t kStoneStream = 0x7374;
/// Share of the bed's volume filled by balls dropped as in pack_balls().
constexpr double kPackedShare = 0.5;

/// A unit ball with flat faces cut off and rounded edges.
class Stone {
 public:
  Stone(const TileShape& shape, size_t number) : irregularity_(shape.irregularity) {
    RandomStream random(shape.seed, kStoneStream, number);
    for (Face& face : faces_) {
      const double z = 2.0 * double(random.next()) - 1, longitude = 2 * kPiD * double(random.next());
      const double s = std::sqrt(1 - z * z);
      face.normal = {s * std::cos(longitude), s * std::sin(longitude), z};
      face.distance = glm::mix(kDeepestCut, 1.0, double(random.next()));
    }
  }

  /// Distance of the surface from the center along `direction`, at most 1.
  double radius(const Vec3d& direction) const {
    // Smooth minimum of the distances to the ball and all faces: a p-norm of their reciprocals, which rounds the edges.
    double sum = 1;
    for (const Face& face : faces_) {
      const double reciprocal = glm::dot(face.normal, direction) / face.distance;
      if (reciprocal > 0) sum += std::pow(reciprocal, kSharpness);
    }
    return 1 - irregularity_ * (1 - std::pow(sum, -1 / kSharpness));
  }

 private:
  static constexpr double kDeepestCut = 0.5, kSharpness = 12;
  struct Face {
    Vec3d normal;
    double distance;
  };
  std::array<Face, 14> faces_;
  double irregularity_;
};

constexpr uint32_t kFloorSlot = 0, kStoneSlots = 3;

TileMaterial mineral(const char* name, float gray, float warmth) {
  // Dry stone is purely diffuse.
  return {name, {.base_color = {gray + warmth, gray, gray - warmth}, .roughness = 1, .specular = 0}};
}

void add_floor(MeshBuilder& builder, double size) {
  builder.add_grid({.cells_u = 1,
                    .cells_v = 1,
                    .end_u = GridEnd::repeat({size, 0, 0}),
                    .end_v = GridEnd::repeat({0, size, 0}),
                    .slot = kFloorSlot},
                   [](double, double) { return Vec3d(0.0); });
}

}  // namespace

std::vector<Ball> gravel_balls(const TileShape& shape) {
  const double radius = std::min(0.55 * shape.pitch(), 0.25 * shape.size);
  return pack_balls({.period = shape.size,
                     .largest_radius = radius,
                     .smallest_radius = 0.6 * radius,
                     .volume = kPackedShare * shape.size * shape.size * shape.thickness * shape.pitch(),
                     .seed = shape.seed});
}

TileParts make_gravel(const TileShape& shape) {
  MeshBuilder builder;
  add_floor(builder, shape.size);
  const std::vector<Ball> balls = gravel_balls(shape);
  for (size_t i = 0; i < balls.size(); ++i) {
    const Stone stone(shape, i);
    const auto slot = static_cast<uint32_t>(1 + i % kStoneSlots);
    builder.add_globe(shape.resolution, slot, [&](const Vec3d& direction) {
      return balls[i].center + balls[i].radius * stone.radius(direction) * direction;
    });
  }
  return {.mesh = builder.finish(),
          .materials = {mineral("floor", 0.12f, 0.02f), mineral("pale stone", 0.5f, 0.03f),
                        mineral("gray stone", 0.32f, 0.0f), mineral("dark stone", 0.18f, -0.01f)},
          .open = false,
          .open_area = 0.0};
}

namespace {

constexpr uint64_t kStream = 0x6261;
constexpr int kPlacesTried = 400;

/// Balls by the cell of a periodic grid that their centers lie in.
class BallGrid {
 public:
  explicit BallGrid(const PackingOptions& options)
      : period_(options.period),
        largest_radius_(options.largest_radius),
        cells_across_(std::max(1, static_cast<int>(options.period / (2 * options.largest_radius)))),
        cells_(static_cast<size_t>(cells_across_ * cells_across_)) {}

  void add(const Ball& ball) {
    std::vector<Ball>& cell = cells_[index(cell_of(ball.center.x), cell_of(ball.center.y))];
    const auto higher = [](const Ball& a, const Ball& b) { return a.center.z > b.center.z; };
    cell.insert(std::ranges::upper_bound(cell, ball, higher), ball);
  }

  /// Height of the center at which a ball falling straight down comes to rest.
  double resting_height(const Ball& falling) const {
    double height = falling.radius;
    const int column = cell_of(falling.center.x), row = cell_of(falling.center.y);
    for (int y = row - 1; y <= row + 1; ++y)
      for (int x = column - 1; x <= column + 1; ++x) height = height_above(cells_[index(x, y)], falling, height);
    return height;
  }

 private:
  /// The greater of `height` and the height at which `falling` rests on a ball of the cell.
  double height_above(const std::vector<Ball>& cell, const Ball& falling, double height) const {
    for (const Ball& other : cell) {
      if (other.center.z + falling.radius + largest_radius_ < height) break;  // nor do lower balls reach it
      const Vec3d d = periodic_difference(falling.center, other.center, period_);
      const double reach = falling.radius + other.radius, room = reach * reach - d.x * d.x - d.y * d.y;
      if (room > 0) height = std::max(height, other.center.z + std::sqrt(room));
    }
    return height;
  }
  int cell_of(double coordinate) const {
    return std::min(static_cast<int>(coordinate / period_ * cells_across_), cells_across_ - 1);
  }
  /// `x` and `y`: -1 to cells_across_.
  size_t index(int x, int y) const {
    const int n = cells_across_;
    return static_cast<size_t>((y + n) % n) * static_cast<size_t>(n) + static_cast<size_t>((x + n) % n);
  }

  double period_, largest_radius_;
  int cells_across_;
  std::vector<std::vector<Ball>> cells_;  // the highest ball of a cell first
};

}  // namespace

Vec3d periodic_difference(const Vec3d& a, const Vec3d& b, double period) {
  Vec3d d = b - a;
  d.x -= period * std::round(d.x / period);
  d.y -= period * std::round(d.y / period);
  return d;
}

std::vector<Ball> pack_balls(const PackingOptions& options) {
  std::vector<Ball> balls;
  BallGrid grid(options);
  double volume = 0;
  while (volume < options.volume) {
    RandomStream random(options.seed, kStream, balls.size());
    const double radius = glm::mix(options.smallest_radius, options.largest_radius, double(random.next()));
    Ball best{.center = Vec3d(0, 0, std::numeric_limits<double>::infinity()), .radius = radius};
    for (int i = 0; i < kPlacesTried; ++i) {
      const Vec2 u = random.next2();
      Ball ball{.center = Vec3d(options.period * u.x, options.period * u.y, 0), .radius = radius};
      ball.center.z = grid.resting_height(ball);
      if (ball.center.z < best.center.z) best = ball;
    }
    balls.push_back(best);
    grid.add(best);
    volume += 4.0 / 3.0 * kPiD * radius * radius * radius;
  }
  return balls;
}

}  // namespace velour

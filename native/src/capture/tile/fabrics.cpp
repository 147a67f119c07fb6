#include "capture/tile/fabrics.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "capture/tile/mesh_builder.h"
#include "math/sphere/random.h"

namespace velour {

namespace {

/// True where weft yarn `weft` (along x) passes above warp yarn `warp` (along y); periodic in both.
using Pattern = bool (*)(int weft, int warp);

bool plain(int weft, int warp) { return (weft + warp) % 2 == 0; }
bool twill_2_2(int weft, int warp) { return (warp + 4 - weft % 4) % 4 < 2; }
/// 3/1 twill, warp-faced.
bool twill_3_1(int weft, int warp) { return (warp + 4 - weft % 4) % 4 == 0; }
/// Five-end satin, warp-faced, with a step of two between the crossings of neighboring wefts.
bool satin_5(int weft, int warp) { return (warp + 3 * weft) % 5 == 0; }

/// One set of yarns of a cloth; `s` counts pitches along a yarn from its first crossing.
class Yarns {
 public:
  Yarns(const TileShape& shape, Pattern pattern, bool along_x)
      : shape_(shape),
        pattern_(pattern),
        along_x_(along_x),
        half_width_(0.5 * (1 - shape.gap) * shape.pitch()),
        half_height_(0.5 * shape.thickness * shape.pitch()),
        rise_(half_height_ * yarn_amplitude(0.5 * (1 - shape.gap))) {}

  void add(MeshBuilder& builder, uint32_t slot) const {
    const MeshBuilder::Grid grid{
        .cells_u = shape_.count * shape_.resolution,
        .cells_v = shape_.resolution,
        .end_u = GridEnd::repeat(along_x_ ? Vec3d(shape_.size, 0, 0) : Vec3d(0, shape_.size, 0)),
        .end_v = GridEnd::join(),
        .slot = slot};
    for (int yarn = 0; yarn < shape_.count; ++yarn) {
      builder.add_grid(grid, [&, yarn](double u, double v) { return point(yarn, u, v); });
    }
  }

 private:
  Vec3d point(int yarn, double u, double v) const {
    const double angle = 2 * kPiD * (along_x_ ? -v : v);  // orients both sets outward
    const double width = thickness_share(yarn, u);
    const double along = u * shape_.size;
    const double across = (yarn + 0.5) * shape_.pitch() + half_width_ * width * std::cos(angle);
    const double z = rise_ * height(yarn, u * shape_.count - 0.5) + half_height_ * width * std::sin(angle);
    return along_x_ ? Vec3d(along, across, z) : Vec3d(across, along, z);
  }

  /// Thickness relative to the ideal shape, at most 1, so that yarns stay within the bounds that keep them apart.
  double thickness_share(int yarn, double u) const {
    const uint64_t stream = 2 * static_cast<uint64_t>(yarn) + (along_x_ ? 1 : 0);
    return 1 - shape_.irregularity * PeriodicNoise{shape_.seed, stream, {shape_.count, 1}}({u, 0});
  }

  double height(int yarn, double s) const {
    const double crossing = std::floor(s);
    const double here = sign(yarn, int(crossing)), next = sign(yarn, int(crossing) + 1);
    return here == next ? here : here * yarn_wave(s - crossing);
  }

  double sign(int yarn, int crossing) const {
    const int other = (crossing + shape_.count) % shape_.count;
    const bool weft_above = along_x_ ? pattern_(yarn, other) : pattern_(other, yarn);
    return weft_above == along_x_ ? 1 : -1;
  }

  TileShape shape_;
  Pattern pattern_;
  bool along_x_;
  double half_width_, half_height_;
  double rise_;  // height of a yarn's center at a crossing
};

TileParts make_cloth(const TileShape& shape, Pattern pattern, std::vector<TileMaterial> materials) {
  MeshBuilder builder;
  Yarns(shape, pattern, false).add(builder, 0);
  Yarns(shape, pattern, true).add(builder, static_cast<uint32_t>(materials.size()) - 1);
  TileParts parts{.mesh = builder.finish(), .materials = std::move(materials), .open = true};
  if (shape.irregularity == 0) parts.open_area = shape.gap * shape.gap;
  return parts;
}

TileMaterial yarn(const char* name, const Rgb& color, float roughness) {
  return {name, {.base_color = color, .roughness = roughness}};
}

}  // namespace

double yarn_wave(double u) {
  const double c = std::cos(kPiD * u);
  return 0.5 * c * (3 - c * c);
}

double yarn_amplitude(double half_width) {
  double amplitude = 1;
  constexpr int kSteps = 512;
  for (int i = 0; i < kSteps; ++i) {
    const double d = i / double(kSteps);
    amplitude = std::max(amplitude, std::sqrt(1 - d * d) / yarn_wave(d * half_width));
  }
  return amplitude;
}

TileParts make_weave(const TileShape& shape) {
  return make_cloth(shape, plain,
                    {yarn("warp", {0.05f, 0.16f, 0.42f}, 0.3f), yarn("weft", {0.72f, 0.66f, 0.52f}, 0.3f)});
}

TileParts make_twill(const TileShape& shape) {
  return make_cloth(shape, twill_2_2,
                    {yarn("warp", {0.02f, 0.045f, 0.14f}, 0.6f), yarn("weft", {0.6f, 0.58f, 0.52f}, 0.6f)});
}

TileParts make_denim(const TileShape& shape) {
  return make_cloth(shape, twill_3_1,
                    {yarn("warp", {0.015f, 0.04f, 0.16f}, 0.6f), yarn("weft", {0.3f, 0.29f, 0.27f}, 0.6f)});
}

TileParts make_satin(const TileShape& shape) {
  return make_cloth(shape, satin_5,
                    {yarn("warp", {0.62f, 0.5f, 0.38f}, 0.25f), yarn("weft", {0.55f, 0.42f, 0.32f}, 0.35f)});
}

TileParts make_net(const TileShape& shape) {
  return make_cloth(shape, plain, {yarn("cord", {0.45f, 0.3f, 0.14f}, 0.6f)});
}

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

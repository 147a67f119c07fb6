#include "capture/tile/woven.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include "capture/tile/mesh_builder.h"
#include "math/sphere/random.h"

namespace velour {

namespace {

/// True where weft yarn `weft` (along x) passes above warp yarn `warp` (along y); periodic in both.
using Pattern = bool (*)(int weft, int warp);

bool plain(int weft, int warp) { return (weft + warp) % 2 == 0; }
bool twill_2_2(int weft, int warp) { return (warp + 4 - weft % 4) % 4 < 2; }

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

TileParts make_net(const TileShape& shape) {
  return make_cloth(shape, plain, {yarn("cord", {0.45f, 0.3f, 0.14f}, 0.6f)});
}

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

namespace {

double smooth(double t) { return t * t * (3 - 2 * t); }

int wrapped(int i, int n) { return ((i % n) + n) % n; }

}  // namespace

double PeriodicNoise::operator()(const glm::dvec2& at) const {
  const glm::dvec2 place = at * glm::dvec2(cells), corner = glm::floor(place), rest = place - corner;
  const auto value = [&](int dx, int dy) {
    const int x = wrapped(int(corner.x) + dx, cells.x), y = wrapped(int(corner.y) + dy, cells.y);
    return double(
        RandomStream(seed, stream, static_cast<uint64_t>(y) * static_cast<uint64_t>(cells.x) + static_cast<uint64_t>(x))
            .next());
  };
  const double u = smooth(rest.x), v = smooth(rest.y);
  return glm::mix(glm::mix(value(0, 0), value(1, 0), u), glm::mix(value(0, 1), value(1, 1), u), v);
}

}  // namespace velour

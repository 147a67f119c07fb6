#include "capture/tile/woven.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include "capture/tile/mesh_builder.h"
#include "capture/tile/periodic_noise.h"

namespace velour {

namespace {

/// True where weft yarn `weft` (along x) passes above warp yarn `warp` (along y); periodic in both.
using Pattern = bool (*)(int weft, int warp);

bool plain(int weft, int warp) { return (weft + warp) % 2 == 0; }
bool twill_2_2(int weft, int warp) { return (warp + 4 - weft % 4) % 4 < 2; }
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

TileParts make_satin(const TileShape& shape) {
  return make_cloth(shape, satin_5,
                    {yarn("warp", {0.62f, 0.5f, 0.38f}, 0.25f), yarn("weft", {0.55f, 0.42f, 0.32f}, 0.35f)});
}

TileParts make_net(const TileShape& shape) {
  return make_cloth(shape, plain, {yarn("cord", {0.45f, 0.3f, 0.14f}, 0.6f)});
}

}  // namespace velour

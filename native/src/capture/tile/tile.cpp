#include "capture/tile/tile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "capture/tile/bodies.h"
#include "capture/tile/fabrics.h"

namespace velour {
namespace {

/// Bounds the number of triangles: eight million for chain mail, the finest kind.
constexpr int kMaxPointsAcross = 1024;
constexpr int kMinResolution = 6;
constexpr double kMinSize = 1e-6, kLargestSize = 1e3;
constexpr double kMinThickness = 0.01;

constexpr TileShape shape_of(double size, int count, int resolution, double thickness, double gap,
                             double irregularity) {
  return {size, count, resolution, thickness, gap, irregularity, 0};
}

constexpr double kNoGap = 0;
constexpr std::array kKinds = {
    TileKind{"weave", "plain weave: yarns over one, under one", shape_of(2e-3, 4, 16, 0.3, 0.1, 0.1), 2, 0.04, 0.6,
             true, make_weave},
    TileKind{"twill", "2/2 twill: yarns over two, under two, shifted by one each row",
             shape_of(2e-3, 4, 16, 0.3, 0.1, 0.1), 4, 0.04, 0.6, true, make_twill},
    TileKind{"net", "crossed cords around square holes", shape_of(2e-2, 4, 16, 0.22, 0.78, 0.0), 2, 0.3, 0.6, true,
             make_net},
    TileKind{"chainmail", "European four-in-one chain mail", shape_of(2e-2, 4, 12, 0.26, kNoGap, 0.0), 2, kNoGap,
             kThickestWire, false, make_chainmail},
    TileKind{"gravel", "a bed of pebbles on a floor", shape_of(2e-2, 6, 20, 1.6, kNoGap, 0.6), 1, kNoGap, 8.0, true,
             make_gravel},
    TileKind{"corduroy", "ribs of pile with grooves between them", shape_of(6e-3, 4, 32, 0.45, 0.12, 0.25), 1, 0.02,
             2.0, true, make_corduroy},
    TileKind{"satin", "five-end satin: warp over four, under one", shape_of(1.5e-3, 5, 16, 0.2, 0.06, 0.1), 5, 0.04,
             0.6, true, make_satin},
    TileKind{"knit", "plain knit of three-ply yarn", shape_of(9e-3, 3, 18, 0.24, kNoGap, 0.1), 3, kNoGap, kThickestYarn,
             true, make_knit},
    TileKind{"velvet", "upright fibers on a ground", shape_of(2e-3, 28, 8, 6, 0.35, 0.3), 1, 0.2, 20.0, true,
             make_velvet},
    TileKind{"leather", "grained leather: cushions between creases", shape_of(8e-3, 7, 16, 0.2, 0.7, 0.8), 1, 0.05, 1.0,
             true, make_leather},
    TileKind{"denim", "3/1 twill: warp over three, under one", shape_of(2e-3, 4, 16, 0.3, 0.06, 0.1), 4, 0.04, 0.6,
             true, make_denim},
};

template <typename T>
void check(const TileKind& kind, const char* name, T value, T least, T largest) {
  if (value >= least && value <= largest) return;  // false for NaN
  std::ostringstream sentence;
  sentence << "The " << name << " of a " << kind.name << " tile is " << value << "; it must be " << least << " to "
           << largest << ".";
  throw Error(Status::invalid_argument, sentence.str());
}

void check_multiple(const TileKind& kind, const char* name, int value, int multiple) {
  if (value % multiple == 0) return;
  throw Error(Status::invalid_argument, std::string("The ") + name + " of a " + kind.name + " tile is " +
                                            std::to_string(value) + "; it must be a multiple of " +
                                            std::to_string(multiple) + ", or the tile has a seam.");
}

void check(const TileKind& kind, const TileShape& shape) {
  check(kind, "size", shape.size, kMinSize, kLargestSize);
  check(kind, "resolution", shape.resolution, kMinResolution, kMaxPointsAcross);
  check_multiple(kind, "resolution", shape.resolution, 2);
  check(kind, "count", shape.count, std::max(kind.multiple, 1), kMaxPointsAcross / shape.resolution);
  check_multiple(kind, "count", shape.count, kind.multiple);
  check(kind, "thickness", shape.thickness, kMinThickness, kind.largest_thickness);
  check(kind, "gap", shape.gap, kind.least_gap, kind.least_gap > 0 ? 0.95 : 0.0);
  check(kind, "irregularity", shape.irregularity, 0.0, kind.has_irregularity ? 1.0 : 0.0);
}

TileShape completed(const TileOptions& options, const TileShape& defaults) {
  return {.size = options.size.value_or(defaults.size),
          .count = options.count.value_or(defaults.count),
          .resolution = options.resolution.value_or(defaults.resolution),
          .thickness = options.thickness.value_or(defaults.thickness),
          .gap = options.gap.value_or(defaults.gap),
          .irregularity = options.irregularity.value_or(defaults.irregularity),
          .seed = options.seed};
}

const TileKind& kind_named(const std::string& name) {
  std::string names;
  for (const TileKind& kind : kKinds) {
    if (name == kind.name) return kind;
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  }
  throw Error(Status::invalid_argument, "Unknown tile '" + name + "'; use one of " + names + ".");
}

}  // namespace

std::span<const TileKind> tile_kinds() { return kKinds; }

Tile make_tile(const TileOptions& options) {
  const TileKind& kind = kind_named(options.kind);
  const TileShape shape = completed(options, kind.defaults);
  check(kind, shape);
  const auto side = static_cast<float>(shape.size);
  return {.kind = kind.name, .shape = shape, .period = {side, side}, .parts = kind.make(shape)};
}

}  // namespace velour

#include "realtime/maps.h"

#include <algorithm>
#include <string>

#include "base/error.h"
#include "btf/measure/relief.h"
#include "image/texels.h"

namespace velour {

namespace {

constexpr uint32_t kPerLayer = 4;

std::vector<BtfMaps::Term> terms_of(const SrbfBtf& btf, const SrbfSide& side) {
  std::vector<BtfMaps::Term> terms;
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const uint16_t lobe : side.lobe[axis]) {
      terms.push_back({side.lobes[lobe], lobe < side.tile_lobes, btf.axes[static_cast<int>(axis)]});
    }
  }
  return terms;
}

/// Writes one layer's part of a level; `value(texel x, texel y, to)` gives its four numbers.
template <typename Value>
void write_level(TablePixels& maps, uint32_t first_row, const BtfMaps::Level& level, const Value& value) {
  for (uint32_t y = 0; y < level.height + 2 * kTableBorder; ++y) {
    for (uint32_t x = 0; x < level.width + 2 * kTableBorder; ++x) {
      value(wrapped_texel(x, level.width), wrapped_texel(y, level.height),
            maps.at(level.x - kTableBorder + x, first_row + y));
    }
  }
}

Relief relief_of(const SrbfLevel& level, float aspect) {
  std::vector<float> heights(level.relief.size());
  halves_to_floats(level.relief, heights);
  return {level.width, level.height, heights, aspect};
}

BtfMaps maps_of(const SrbfBtf& btf, const SrbfSide& side) {
  BtfMaps out;
  out.terms = terms_of(btf, side);
  out.aspect = tile_aspect(btf.grid);
  const auto coefficients = static_cast<uint32_t>(out.terms.size());
  out.layers = (coefficients + kPerLayer - 1) / kPerLayer + 1;
  uint32_t width = 0;
  for (const SrbfLevel& level : side.levels) {
    out.levels.push_back({width + kTableBorder, level.width, level.height});
    width += level.width + 2 * kTableBorder;
  }
  const uint32_t rows = side.levels[0].height + 2 * kTableBorder;
  out.maps = TablePixels(width, rows * out.layers);
  for (size_t i = 0; i < side.levels.size(); ++i) {
    const SrbfLevel& level = side.levels[i];
    const Relief relief = relief_of(level, out.aspect);
    if (i == 0) {
      const auto [low, high] = std::minmax_element(relief.heights().begin(), relief.heights().end());
      out.bottom = *low;
      out.top = *high;
    }
    for (uint32_t layer = 0; layer + 1 < out.layers; ++layer) {
      write_level(out.maps, layer * rows, out.levels[i], [&](uint32_t x, uint32_t y, float* to) {
        const size_t texel = size_t{y} * level.width + x;
        for (uint32_t k = layer * kPerLayer; k < std::min(coefficients, (layer + 1) * kPerLayer); ++k) {
          to[k % kPerLayer] = side.scale[k].value(level.value[texel * coefficients + k]);
        }
      });
    }
    write_level(out.maps, (out.layers - 1) * rows, out.levels[i], [&](uint32_t x, uint32_t y, float* to) {
      const Vec2 slope = relief.slope(x, y);
      to[0] = relief.height_of(x, y);
      to[1] = slope.x;
      to[2] = slope.y;
    });
  }
  return out;
}

}  // namespace

std::vector<BtfMaps> btf_maps(const SrbfBtf& btf) {
  const auto above = serving_side(btf, false, false), below = serving_side(btf, true, true);
  if (!above)
    throw Error(Status::invalid_argument,
                "The BTF model has no side that is viewed and lit from above, which the real-time viewport requires.");
  std::vector<BtfMaps> sides{maps_of(btf, btf.sides[*above])};
  if (below && below != above) sides.push_back(maps_of(btf, btf.sides[*below]));
  return sides;
}

namespace {

/// Distances of the points, which repeat along x and y.
class Distances {
 public:
  explicit Distances(const VotfVolume& volume) : v_(volume) {}

  float at(uint32_t x, uint32_t y, uint32_t z) const {
    const int byte = v_.distance[(size_t{z} * v_.height + y) * v_.width + x];
    return v_.reach * static_cast<float>(byte - VotfVolume::kZero) / VotfVolume::kUnits;
  }
  /// Writes distance and slope: central differences, one-sided at both ends of z.
  void write(uint32_t x, uint32_t y, uint32_t z, float* to) const {
    const uint32_t right = (x + 1) % v_.width, left = (x + v_.width - 1) % v_.width, back = (y + 1) % v_.height,
                   front = (y + v_.height - 1) % v_.height, low = z > 0 ? z - 1 : z,
                   high = std::min(z + 1, v_.depth - 1);
    const float along_y = v_.aspect / static_cast<float>(v_.height);
    to[0] = at(x, y, z);
    to[1] = (at(right, y, z) - at(left, y, z)) / (2 * v_.pitch());
    to[2] = (at(x, back, z) - at(x, front, z)) / (2 * along_y);
    to[3] = high > low ? (at(x, y, high) - at(x, y, low)) / (static_cast<float>(high - low) * v_.step()) : 1.0f;
  }

 private:
  const VotfVolume& v_;
};

}  // namespace

TablePixels shell_maps(const VotfVolume& volume) {
  const uint32_t width = volume.width + 2 * kTableBorder, height = volume.height + 2 * kTableBorder;
  const uint64_t pixels = uint64_t{width} * height * volume.depth;
  if (pixels > kMaxShellPixels) {
    throw Error(Status::unsupported, "The silhouette (VOTF) has " + std::to_string(pixels) +
                                         " points, but the real-time viewport supports at most " +
                                         std::to_string(kMaxShellPixels) + ". Create it with fewer texels.");
  }
  TablePixels maps(width, height * volume.depth);
  const Distances distances(volume);
  for (uint32_t z = 0; z < volume.depth; ++z) {
    for (uint32_t y = 0; y < height; ++y) {
      for (uint32_t x = 0; x < width; ++x) {
        distances.write(wrapped_texel(x, volume.width), wrapped_texel(y, volume.height), z, maps.at(x, z * height + y));
      }
    }
  }
  return maps;
}

}  // namespace velour

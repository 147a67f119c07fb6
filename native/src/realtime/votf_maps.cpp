#include "realtime/votf_maps.h"

#include <algorithm>
#include <string>

#include "base/error.h"

namespace velour {
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

// A BTF as sums of multivariate SRBFs over a relief.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "btf/btf_measurement.h"
#include "btf/factored_btf.h"
#include "btf/sides.h"
#include "srbf/multivariate_lobes.h"

namespace velour {

/// What a coefficient's bytes stand for: least + step * byte.
struct ByteScale {
  float least = 0, step = 0;

  uint8_t nearest(float value) const;
  float value(uint8_t byte) const { return least + step * static_cast<float>(byte); }
};

/// One level of the pyramid over the tile.
struct SrbfLevel {
  uint32_t width = 0, height = 0;
  std::vector<HalfBits> relief;  // [row][column]: over the reference plane, widths of the tile
  std::vector<uint8_t> value;    // [row][column][coefficient], row 0 at the bottom: SrbfSide::scale
};

/// What is seen from one side of the reference plane under light from one side: both are looked at in the frame of the
/// viewer, or of the light, mirrored to z > 0.
///
/// Let p be where the view's ray meets the relief of the level (Relief::seen). With a = a colour axis, the sum at p is
///   s_a = sum over the coefficients k of a of value_k(p) g_{lobe_k}(wl, wv)
/// and f = expanded(axes (s_0, s_1, s_2)). The first `tile_lobes` are functions of the directions in the tile's frame;
/// the others, in the frame of the relief's normal at p: the tile's, turned the shortest way.
struct SrbfSide {
  bool view_below = false, light_below = false;
  std::vector<MultivariateLobe> lobes;
  uint32_t tile_lobes = 0;
  std::array<std::vector<uint16_t>, 3> lobe;  // of each axis' coefficients: of axis 0 every lobe in order
  std::vector<ByteScale> scale;               // of each coefficient, on all levels
  std::vector<SrbfLevel> levels;              // the finest first; each half of the one before, down to one texel

  /// Sets what bytes stand for: from the least to the largest value of each coefficient, `levels` finest first,
  /// [texel][coefficient].
  void set_scale(const std::vector<std::vector<float>>& levels);
  /// Sets the values of all levels: the nearest bytes.
  void set_values(const std::vector<std::vector<float>>& levels);

  size_t coefficients() const { return lobe[0].size() + lobe[1].size() + lobe[2].size(); }
  /// Of all coefficients, heights and lobes as they are stored.
  uint64_t parameter_bytes() const;
};

struct SrbfBtf {
  PairLayout layout;  // that was fitted
  TexelGrid grid;
  Companding companding = Companding::root;
  Mat3 axes{1.0f};  // columns: orthonormal directions in RGB
  std::vector<SrbfSide> sides;
  std::vector<SharedSide> shared = {};

  uint64_t parameter_bytes() const;

  static constexpr size_t kMaxLobes = 256;
};

/// The tile's extent along y over that along x; square texels where its size is not known.
float tile_aspect(const TexelGrid& grid);

/// The rotation that takes the normal of a Relief::slope() to +z the shortest way: Rodrigues' formula about
/// (n.y, -n.x, 0), whose length is the sine. One division, because evaluation waits for it.
inline Mat3 to_normal(const Vec2& slope) {
  const float square = 1 + glm::dot(slope, slope), length = std::sqrt(square);
  const float one = 1 / (square + length), z = one * (length + 1), a = one * square;  // a = 1 / (1 + z)
  const Vec3 n(slope * z, z);
  const float xy = -a * n.x * n.y;
  return {Vec3(1 - a * n.x * n.x, xy, n.x), Vec3(xy, 1 - a * n.y * n.y, n.y), Vec3(-n.x, -n.y, n.z)};
}

}  // namespace velour

// A BTF as sums of multivariate SRBFs over a relief.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>
#include "btf/measure/btf_measurement.h"
#include "btf/model/factored_btf.h"
#include "math/srbf/multivariate_lobes.h"

namespace velour {

// Selects the side of a BTF model for a viewer and a light.

/// A side that equals another one within measurement noise and stores no data of its own.
struct SharedSide {
  bool view_below = false, light_below = false;
  uint32_t side = 0;  // index in `sides`
};

/// Index of the side for this view and light; empty if the model has none. `Btf` has `sides` and `shared`.
template <typename Btf>
std::optional<uint32_t> serving_side(const Btf& btf, bool view_below, bool light_below) {
  for (uint32_t i = 0; i < btf.sides.size(); ++i) {
    if (btf.sides[i].view_below == view_below && btf.sides[i].light_below == light_below) return i;
  }
  for (const SharedSide& shared : btf.shared) {
    if (shared.view_below == view_below && shared.light_below == light_below) return shared.side;
  }
  return std::nullopt;
}

/// Quantization of a coefficient: value = least + step * byte.
struct ByteScale {
  float least = 0, step = 0;

  uint8_t nearest(float value) const;
  float value(uint8_t byte) const { return least + step * static_cast<float>(byte); }
};

/// One mip level of the tile.
struct SrbfLevel {
  uint32_t width = 0, height = 0;
  std::vector<HalfBits> relief;  // [row][column]: height over the reference plane, in tile widths
  std::vector<uint8_t> value;    // [row][column][coefficient], row 0 at the bottom; see SrbfSide::scale
};

/// Appearance from one side of the reference plane under light from one side. View and light directions are mirrored to
/// z > 0.
///
/// Let p be the point where the view ray hits the relief of the level (Relief::seen). The sum of color axis a at p is
///   s_a = sum over the coefficients k of a of value_k(p) g_{lobe_k}(wl, wv)
/// and f = expanded(axes (s_0, s_1, s_2)). The first `tile_lobes` lobes take directions in the tile's frame; the others
/// in the frame of the relief's normal at p, which is the tile's frame after the shortest rotation.
struct SrbfSide {
  bool view_below = false, light_below = false;
  std::vector<MultivariateLobe> lobes;
  uint32_t tile_lobes = 0;
  std::array<std::vector<uint16_t>, 3> lobe;  // lobe of each axis's coefficients; axis 0 has every lobe, in order
  std::vector<ByteScale> scale;               // per coefficient, shared by all levels
  std::vector<SrbfLevel> levels;              // finest first; each half the size of the previous one, down to one texel

  /// Sets the scales to the range of each coefficient. `levels`: finest first, [texel][coefficient].
  void set_scale(const std::vector<std::vector<float>>& levels);
  /// Quantizes the values of all levels to the nearest bytes.
  void set_values(const std::vector<std::vector<float>>& levels);

  size_t coefficients() const { return lobe[0].size() + lobe[1].size() + lobe[2].size(); }
  /// Size of all coefficients, heights and lobes as stored.
  uint64_t parameter_bytes() const;
};

struct SrbfBtf {
  PairLayout layout;  // layout of the fitted BTF
  TexelGrid grid;
  Companding companding = Companding::root;
  Mat3 axes{1.0f};  // columns: orthonormal directions in RGB
  std::vector<SrbfSide> sides;
  std::vector<SharedSide> shared = {};

  uint64_t parameter_bytes() const;

  static constexpr size_t kMaxLobes = 256;
};

/// The tile's extent along y divided by that along x. Assumes square texels if the tile size is unknown.
float tile_aspect(const TexelGrid& grid);

/// The shortest rotation that takes the normal of a Relief::slope() to +z: Rodrigues' formula about (n.y, -n.x, 0),
/// whose length is the sine. One division only, because evaluation waits for it.
inline Mat3 to_normal(const Vec2& slope) {
  const float square = 1 + glm::dot(slope, slope), length = std::sqrt(square);
  const float one = 1 / (square + length), z = one * (length + 1), a = one * square;  // a = 1 / (1 + z)
  const Vec3 n(slope * z, z);
  const float xy = -a * n.x * n.y;
  return {Vec3(1 - a * n.x * n.x, xy, n.x), Vec3(xy, 1 - a * n.y * n.y, n.y), Vec3(-n.x, -n.y, n.z)};
}

}  // namespace velour

// BTFs and VOTFs as maps and volumes that a shader interpolates.
#pragma once

#include <vector>
#include "btf/model/srbf_btf.h"
#include "realtime/lobe_rows.h"
#include "votf/eval/occlusion_volume.h"

namespace velour {

// A BTF of multivariate SRBFs as maps that a shader interpolates.

/// One side of a BTF, f = expanded(axes s) as in btf/model/srbf_btf.h. `maps` stacks `layers` vertically, each of
/// maps.height / layers rows: four coefficients per layer, in the order of `terms` and padded with zeros, then one
/// layer of the relief: height over the reference plane in tile widths, and its slope along x and y. A layer has all
/// levels of the pyramid side by side, each with a border of one pixel that repeats the tile.
struct BtfMaps {
  struct Level {
    uint32_t x, width, height;  // x of the first pixel inside the border, which is in the second row
  };
  /// A coefficient: the lobe that it multiplies, and the color of its axis.
  struct Term {
    MultivariateLobe lobe;
    bool in_tile;  // the lobe is in the tile's frame, otherwise in that of the relief's normal
    Vec3 color;
  };

  uint32_t layers = 0;
  std::vector<Level> levels;
  std::vector<Term> terms;
  float bottom = 0, top = 0, aspect = 1;  // of the finest relief
  TablePixels maps = {};
};

/// Maps of the side seen and lit from above and, if the BTF has its own, of the side seen and lit from below, whose two
/// directions are mirrored to z > 0. Throws Error(invalid_argument) for a BTF without the first.
std::vector<BtfMaps> btf_maps(const SrbfBtf& btf);

// The VOTF of a material as a volume that a shader interpolates.

/// The table stacks volume.depth layers vertically, the lowest first, each of volume.height + 2 rows of volume.width +
/// 2 pixels with a border of one pixel that repeats the tile. A pixel is the signed distance in tile widths and its
/// slope along x, y and z. Throws Error(unsupported) beyond kMaxShellPixels.
TablePixels shell_maps(const VotfVolume& volume);

inline constexpr uint64_t kMaxShellPixels = uint64_t{1} << 23;

}  // namespace velour

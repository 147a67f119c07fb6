// The verdict on the fit of a BTF, from pictures of its tile.
#pragma once

#include <optional>
#include <vector>
#include "base/progress.h"
#include "btf/fit/btf_compare.h"
#include "btf/measure/btf_measurement.h"
#include "verdict/look.h"

namespace velour {

/// The tile as seen from five views, from the normal to 75 degrees, each under three lights up to 65 degrees: of the
/// pairs above the reference plane those nearest to them, each once. A pixel per texel; small tiles are repeated, and
/// at most kMaxPixels of a side are shown. Texels that are not finite equal those of the model.
std::vector<PicturePair> tile_pictures(const BtfMeasurement& measurement, const BtfImages& images,
                                       const Progress& progress);
inline constexpr uint32_t kMaxPixels = 256;

/// Compares the tile_pictures(), with a reason if the verdict is not good. Nothing without pairs above the plane.
std::optional<Verdict> judge_btf(const BtfMeasurement& measurement, const BtfImages& images, const Progress& progress);

}  // namespace velour

// Material of an uncompressed BTF: reference mode.
#pragma once

#include <memory>

#include "btf/btf_table.h"
#include "material/btf_light.h"
#include "material/material.h"

namespace velour {

/// f interpolated from the table: barycentric between views and between lights, bilinear between texels, trilinear
/// between levels along the footprint [Wil83, MPFJ99], all linear in f; negative sums become 0. Texture coordinates are
/// in tiles. Sampling is cosine-weighted.
std::shared_ptr<const Material> make_measured_btf_material(std::shared_ptr<const BtfTable> table,
                                                           BtfLight light = BtfLight::viewers_side);

}  // namespace velour

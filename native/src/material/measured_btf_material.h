// A BTF itself, evaluated at a site of a surface: reference mode.
#pragma once

#include <memory>

#include "btf/btf_table.h"
#include "material/btf_light.h"
#include "material/material.h"

namespace velour {

/// f of the table: barycentric between views and between lights, bilinear between texels, trilinear between levels
/// along the footprint [Wil83, MPFJ99], all in f; negative sums are 0. Texture coordinates count tiles. Samples have
/// the density of the cosine.
std::shared_ptr<const Material> make_measured_btf_material(std::shared_ptr<const BtfTable> table,
                                                           BtfLight light = BtfLight::viewers_side);

}  // namespace velour

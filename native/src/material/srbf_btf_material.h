// Material of a BTF modeled as sums of multivariate SRBFs.
#pragma once

#include <memory>

#include "btf/srbf_btf.h"
#include "material/btf_light.h"
#include "material/material.h"

namespace velour {

/// Texture coordinates are in tiles: the BTF repeats at every integer.
std::shared_ptr<const Material> make_srbf_btf_material(std::shared_ptr<const SrbfBtf> btf,
                                                       BtfLight light = BtfLight::viewers_side);

}  // namespace velour

// Material of a BTF modeled as clustered tensors.
#pragma once

#include <memory>

#include "btf/tensor_btf.h"
#include "material/btf_light.h"
#include "material/material.h"

namespace velour {

/// Texture coordinates are in tiles: the BTF repeats at every integer.
std::shared_ptr<const Material> make_tensor_btf_material(std::shared_ptr<const TensorBtf> btf,
                                                         BtfLight light = BtfLight::viewers_side);

}  // namespace velour

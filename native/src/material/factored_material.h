// Material of a BTF factored into a sum of products.
#pragma once

#include <memory>

#include "btf/factored_btf.h"
#include "material/btf_light.h"
#include "material/material.h"

namespace velour {

/// Texture coordinates are in tiles: the BTF repeats at every integer. Sampling is cosine-weighted, since a
/// factorization has no lobes to sample.
std::shared_ptr<const Material> make_factored_material(std::shared_ptr<const FactoredBtf> btf,
                                                       BtfLight light = BtfLight::viewers_side);

}  // namespace velour

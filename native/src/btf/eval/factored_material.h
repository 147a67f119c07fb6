// A BTF as a sum of products, evaluated at a site of a surface.
#pragma once

#include <memory>

#include "btf/eval/btf_light.h"
#include "btf/model/factored_btf.h"
#include "material/material.h"

namespace velour {

/// Texture coordinates are in tiles: the BTF repeats with every whole number. Samples have the density of the cosine: a
/// factorisation knows no lobes to sample from. Where components serve one view each (by_view()), those of at most
/// three views around the direction are evaluated.
std::shared_ptr<const Material> make_factored_material(std::shared_ptr<const FactoredBtf> btf,
                                                       BtfLight light = BtfLight::viewers_side);

}  // namespace velour

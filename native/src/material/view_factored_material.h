// Material of a factored BTF whose components belong to one view each.
#pragma once

#include <memory>

#include "btf/factored_btf.h"
#include "material/btf_light.h"
#include "material/material.h"

namespace velour {

/// Like make_factored_material, for a BTF with by_view(): evaluates only the components of the views around a
/// direction, three at most.
std::shared_ptr<const Material> make_view_factored_material(std::shared_ptr<const FactoredBtf> btf,
                                                            BtfLight light = BtfLight::viewers_side);

}  // namespace velour

// A BTF whose components serve a view each, evaluated at a site of a surface.
#pragma once

#include <memory>

#include "btf/factored_btf.h"
#include "material/btf_light.h"
#include "material/material.h"

namespace velour {

/// As make_factored_material, of a BTF with by_view(): of all components only those of the views about a direction,
/// three at most, are looked at.
std::shared_ptr<const Material> make_view_factored_material(std::shared_ptr<const FactoredBtf> btf,
                                                            BtfLight light = BtfLight::viewers_side);

}  // namespace velour

// BTFs of two sides with light that comes through, for tests of all kinds of models.
#pragma once

#include "material/derived_materials.h"
#include "support/sided_btfs.h"

namespace velour::test {

/// The sides that look the same from the front and from behind, exchanged, are what comes through.
template <typename Btf>
Btf with_through(Btf btf) {
  for (const bool below : {false, true}) {
    auto side = btf.sides[below ? 0 : 1];
    side.view_below = below;
    side.light_below = !below;
    btf.sides.push_back(side);
  }
  return btf;
}

template <typename Kind>
std::shared_ptr<const ThroughMaterial> through_material(const typename Kind::Btf& of) {
  const auto btf = std::make_shared<const typename Kind::Btf>(of);
  if constexpr (std::is_same_v<Kind, SrbfKind>) {
    return std::make_shared<const ThroughMaterial>(make_srbf_btf_material(btf),
                                                   make_srbf_btf_material(btf, BtfLight::other_side));
  } else {
    return std::make_shared<const ThroughMaterial>(make_tensor_btf_material(btf),
                                                   make_tensor_btf_material(btf, BtfLight::other_side));
  }
}

}  // namespace velour::test

// Selects the side of a BTF model for a viewer and a light.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace velour {

/// A side that equals another one within measurement noise and stores no data of its own.
struct SharedSide {
  bool view_below = false, light_below = false;
  uint32_t side = 0;  // index in `sides`
};

/// Index of the side for this view and light; empty if the model has none. `Btf` has `sides` and `shared`.
template <typename Btf>
std::optional<uint32_t> serving_side(const Btf& btf, bool view_below, bool light_below) {
  for (uint32_t i = 0; i < btf.sides.size(); ++i) {
    if (btf.sides[i].view_below == view_below && btf.sides[i].light_below == light_below) return i;
  }
  for (const SharedSide& shared : btf.shared) {
    if (shared.view_below == view_below && shared.light_below == light_below) return shared.side;
  }
  return std::nullopt;
}

}  // namespace velour

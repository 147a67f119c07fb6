// Texels and views of a factored BTF at a hit.
#pragma once

#include <array>
#include <cstdint>

namespace velour {

/// State of a factored BTF for a site and a view: component coefficients, blended over texels and padded per axis to
/// whole vectors, and the views around the direction.
struct FactoredPoint {
  static constexpr int kMost = 512 + 3 * 16;  // components and padding
  alignas(64) float value[kMost];
  std::array<uint32_t, 3> view;  // rows of each view's first light; with by_view(), indices of the views
  std::array<float, 3> weight;   // all 0: the view is not covered
  bool back;                     // a two-sided BTF seen from below
};

}  // namespace velour

// A BTF's texels and view at a hit.
#pragma once

#include <array>
#include <cstdint>

namespace velour {

/// What the site and the view decide of a factored BTF: its components' coefficients, blended over texels, padded axis
/// by axis to whole vectors; and the views about the direction.
struct FactoredPoint {
  static constexpr int kMost = 512 + 3 * 16;  // components and padding
  alignas(64) float value[kMost];
  std::array<uint32_t, 3> view;  // numbers of rows of the first light; of views, where components serve a view
  std::array<float, 3> weight;   // 0 everywhere: nothing is seen
  bool back;                     // of a BTF with two sides, seen from below
};

}  // namespace velour

// Coefficients of a factored BTF at a hit, and the views around the direction of view.
#pragma once

#include <array>
#include <cstdint>

namespace velour {

/// What site and view decide of a factored BTF: the coefficients of its components, interpolated between texels.
struct FactoredPoint {
  static constexpr int kMost = 512 + 16;  // components, and what vectors read beyond them
  alignas(64) float value[kMost];         // of all components, or of those of each view in turn, times its weight
  std::array<uint32_t, 3> view;           // numbers of views
  std::array<float, 3> weight;            // barycentric; 0 everywhere: the BTF has no view on this side
  bool back;                              // seen from below, in a BTF of two sides
};

}  // namespace velour

// Sums over the lights of a view that its residuals and their derivatives consist of.
#pragma once

#include <algorithm>
#include <vector>
#include "brdf/fit/closures/closure_curves.h"
#include "brdf/fit/closures/closure_lights.h"

namespace velour {

/// Rows over the lights, times root_weight: the diffuse lobe, then of each lobe its value and, with slopes, its
/// derivatives by the unknowns alpha, tilt and anisotropy. Products of the rows with each other and with the target.
struct ViewProducts {
  static constexpr int kSlopeRows = 4, kMaxRows = 1 + kSlopeRows * kMaxClosureLobes;

  ViewProducts(const ClosureTarget& target_at_view, const std::vector<LobeDistribution>& distributions,
               LobeMasking masking, const ClosureBounds& bounds, const ViewUnknowns& u, bool slopes);

  double gram(int a, int b) const { return static_cast<double>(gram_[std::max(a, b) * rows + std::min(a, b)]); }
  /// Integral of a row over the hemisphere.
  double mass(int a) const { return static_cast<double>(target[a][3]); }

  int rows, rows_per_lobe;
  float target[kMaxRows][4];  // with each channel of the target, and with its integral

 private:
  float gram_[kMaxRows * kMaxRows];
};

}  // namespace velour

// An isotropic parametric model, tabulated so that a view costs only a few sums.
#pragma once

#include <oneapi/tbb/cache_aligned_allocator.h>

#include <vector>

#include "brdf/eval/parametric_nodes.h"

namespace velour {

/// Indices of lobes.
struct LobeList {
  uint8_t lobe[WarpedMixture::kCapacity];
  uint8_t count = 0;
};

/// Input of the SIMD kernel.
struct TableRows {
  const float *half, *control;
  const LobeList* lists;
  const ViewSpline& spline;
};

/// Evaluated lobe parameters (no logarithms, no angles) as quadratic splines of the view over about 320 intervals,
/// whose ends include the model's own knots: 165 KB for up to 16 lobes, 83 KB for up to 8. f is that of
/// ParametricValues without the lobes that are negligible at the view (parametric_nodes.h), to within 1e-3 of itself
/// plus 1e-6 of its peak on the test models (at worst 1.4e-3 on measured materials: docs/engine/parametric_model.md),
/// once differentiable in the view and never negative. Immutable; thread-safe; no allocation.
class ParametricTable {
 public:
  /// Empty for anisotropic models: tables over the disk of views would be too large for the cache.
  ParametricTable(const ParametricValues& values, const ParametricNodes& nodes);

  /// False near the normal, where stretches fade within a degree or two, and for anisotropic models.
  bool covers(const Vec3& wv) const { return wv.z <= most_z_; }
  /// Like ParametricValues::evaluate, at a covered view.
  void evaluate(const Vec3& wv, WarpedMixture& mixture) const;

  uint64_t bytes() const { return sizeof(float) * (rows_.size() + half_.size()) + sizeof(LobeList) * lists_.size(); }
  /// Columns of a row, each as long as the padded number of lobes.
  enum Column { kX, kZ, kSxx, kSyy, kBandwidth, kRed, kGreen, kBlue, kColumns };

 private:
  void fill(const ParametricValues& values);
  /// Lists the lobes that matter in each interval and zeroes the coefficients of the others, node by node.
  void leave_out_idle(const ParametricNodes& nodes);
  float& at(size_t node, int column, int lobe) {
    return rows_[(node * kColumns + static_cast<size_t>(column)) * static_cast<size_t>(padded_) +
                 static_cast<size_t>(lobe)];
  }

  int count_, padded_;
  float most_z_;
  ViewSpline spline_;
  std::vector<float> half_;
  std::vector<float, oneapi::tbb::cache_aligned_allocator<float>> rows_;  // [node][column][padded lobe]
  std::vector<LobeList> lists_;  // [node]: lobes for views that depend on this node and the next two
};

}  // namespace velour

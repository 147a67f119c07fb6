// An isotropic parametric model, evaluated beforehand: what a view needs are a few sums.
#pragma once

#include <oneapi/tbb/cache_aligned_allocator.h>

#include <vector>

#include "material/parametric_nodes.h"

namespace velour {

/// Lobes by number.
struct LobeList {
  uint8_t lobe[WarpedMixture::kCapacity];
  uint8_t count = 0;
};

/// What the SIMD kernel reads.
struct TableRows {
  const float *half, *control;
  const LobeList* lists;
  const ViewSpline& spline;
};

/// The evaluated parameters of lobes (no logarithms, no angles) as quadratic splines of the view over some 320
/// intervals, the model's own knots among their ends: 165 KB of up to 16 lobes, 83 KB of up to 8. f is that of
/// ParametricValues, less the lobes that cannot matter at the view (idle_lobes.h), to 1e-3 of itself plus 1e-6 of its
/// peak on the models of the tests (on measured materials 1.4e-3 at worst: docs/parametric.md), once differentiable in
/// the view and never negative. Immutable; thread-safe; no allocation.
class ParametricTable {
 public:
  /// Empty of anisotropic models: tables over the disk of views would be too large for the cache.
  ParametricTable(const ParametricValues& values, const ParametricNodes& nodes);

  /// False near the normal, where stretches fade within a degree or two, and of anisotropic models.
  bool covers(const Vec3& wv) const { return wv.z <= most_z_; }
  /// What ParametricValues::evaluate does, at a view that it covers.
  void evaluate(const Vec3& wv, WarpedMixture& mixture) const;

  uint64_t bytes() const { return sizeof(float) * (rows_.size() + half_.size()) + sizeof(LobeList) * lists_.size(); }
  /// Columns of a row, each of the padded number of lobes.
  enum Column { kX, kZ, kSxx, kSyy, kBandwidth, kRed, kGreen, kBlue, kColumns };

 private:
  void fill(const ParametricValues& values);
  /// Lists the lobes of each interval and takes the coefficients of the others away, node by node.
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
  std::vector<LobeList> lists_;  // for the views that touch this node and the next two
};

}  // namespace velour

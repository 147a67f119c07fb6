// The views of a BTF as matrices, one per color axis.
#pragma once

#include <array>
#include <vector>

#include "base/progress.h"
#include "btf/model/factored_btf.h"
#include "math/tensor/tensor_view.h"

namespace velour {

/// Reads views one by one. Entries that are not finite are counted and replaced by the mean of their image, so that
/// they do not bias the fit. Companding by roots treats negative f as 0.
class CompandedViews {
 public:
  CompandedViews(const BtfMeasurement& btf, Companding companding, int threads, const Progress& progress);

  /// Reads linear f, [light][texel x 3].
  void read(uint32_t view, std::vector<float>& f);
  /// Companded f along the three axes, a matrix light x texel each.
  using Planes = std::array<RowMatrix, 3>;
  void planes(const std::vector<float>& f, uint64_t texels, Planes& planes) const;

  /// Decorrelated color axes: eigenvectors of the mean outer product of companded colors, strongest first.
  Mat3 decorrelate();
  void set_axes(const Mat3& axes) { axes_ = axes; }

  /// Sums of squares of the companded values read by decorrelate(), [view][light] of a complete layout.
  const std::vector<double>& energies() const { return energies_; }

  uint32_t views() const { return static_cast<uint32_t>(btf_.layout().views().size()); }
  uint64_t not_finite() const { return not_finite_; }

 private:
  const BtfMeasurement& btf_;
  Companding companding_;
  int threads_;
  const Progress& progress_;
  Mat3 axes_{1.0f};
  std::vector<HalfBits> halves_;
  std::vector<double> energies_;
  uint64_t not_finite_ = 0;  // in the last pass over the views
};

}  // namespace velour

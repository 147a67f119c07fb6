// The views of a BTF as matrices, one a colour axis.
#pragma once

#include <array>
#include <vector>

#include "btf/factored_btf.h"
#include "job/progress.h"
#include "tensor/row_matrix.h"

namespace velour {

/// Reads views one by one. Entries that are not finite are replaced by the mean of their image, so that they pull at
/// nothing; they are counted. Negative f is companded as 0 by roots.
class CompandedViews {
 public:
  CompandedViews(const BtfMeasurement& btf, Companding companding, int threads, const Progress& progress);

  /// [light][texel x 3] of linear f.
  void read(uint32_t view, std::vector<float>& f);
  /// The matrices light x texel of f after companding, along the three axes.
  using Planes = std::array<RowMatrix, 3>;
  void planes(const std::vector<float>& f, uint64_t texels, Planes& planes) const;

  /// Colour axes of least correlation: eigenvectors of the mean outer product of companded colours, strongest first.
  Mat3 decorrelate();
  void set_axes(const Mat3& axes) { axes_ = axes; }

  uint32_t views() const { return static_cast<uint32_t>(btf_.layout().views().size()); }
  uint64_t not_finite() const { return not_finite_; }

 private:
  const BtfMeasurement& btf_;
  Companding companding_;
  int threads_;
  const Progress& progress_;
  Mat3 axes_{1.0f};
  std::vector<HalfBits> halves_;
  uint64_t not_finite_ = 0;  // in the views read last: each counts once a pass
};

}  // namespace velour

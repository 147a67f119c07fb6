// Truncated singular value decomposition of every view on its own.
#pragma once

#include "compress/factored_fit.h"

namespace velour {

/// One matrix of lights times texels per view and decorrelated color axis, decomposed exactly from the products of its
/// rows and truncated to its strongest components; those of all views and axes compete for the bytes. A view that gets
/// none is black.
class ViewSvdFitter final : public FactoredFitter {
 public:
  /// The arguments must outlive the fitter. Only the colors are checkpointed; the decompositions take one pass over the
  /// views. Throws Error(invalid_argument) if the bytes do not hold a single component, Error(unsupported) for an
  /// incomplete layout or too little memory.
  ViewSvdFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
                Progress& progress);

 private:
  void copy_function(const Component& component, Eigen::Ref<Eigen::VectorXf> values) const override;
  void decompose(uint32_t view, std::vector<Component>& components);

  std::vector<std::array<RowMatrix, 3>> function_of_;  // [view][axis]: light x column, orthonormal columns
};

}  // namespace velour

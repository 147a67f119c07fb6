// A truncated singular value decomposition of every view for itself.
#pragma once

#include "compress/factored_fit.h"

namespace velour {

/// A matrix of lights times texels for each view and decorrelated colour axis, decomposed exactly by the products of
/// its rows, and cut to its strongest components; those of all views and axes compete for the bytes. A view that gets
/// none is black.
class ViewSvdFitter final : public FactoredFitter {
 public:
  /// Both must outlive this. Of the checkpoint the colours are taken; the decompositions are one reading of the views.
  /// Throws Error(invalid_argument) when the bytes hold not one component, Error(unsupported) for a layout that is not
  /// complete and for too little memory.
  ViewSvdFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
                Progress& progress);

 private:
  void copy_function(const Component& component, Eigen::Ref<Eigen::VectorXf> values) const override;
  void decompose(uint32_t view, std::vector<Component>& components);

  std::vector<std::array<RowMatrix, 3>> function_of_;  // [view][axis]: light x column, orthonormal columns
};

}  // namespace velour

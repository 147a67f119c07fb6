// Fit of a BTF by clustered tensors.
#pragma once

#include "btf/fit/btf_fitter.h"
#include "btf/fit/fit_checkpoint.h"
#include "btf/fit/fitted_sides.h"
#include "btf/fit/tensor/direction_bases.h"
#include "btf/fit/tensor/shape_search.h"

namespace velour {

/// Requirements for all sides of the layout: dark or equal sides are found only by reading them.
FitSize tensor_fit_size(const BtfMeasurement& measurement, const BtfFitOptions& options);

/// Tucker, CTA and K-CTA, depending on the clusters and members allowed. Some texels, in bases of the views and lights,
/// are clustered (math/tensor/cluster_fit.h). The number of clusters and the ranks that are worth their bytes are
/// searched for first; if two shapes are close, both models are fitted. Clusters are stored as half floats, and the
/// texels of every level are then solved for with the stored clusters.
class TensorFitter final : public BtfFitter {
 public:
  /// The arguments must outlive the fitter. Stages in the checkpoint are reused. Throws Error(invalid_argument) if the
  /// bytes do not hold a model, Error(unsupported) for an incomplete layout or too little memory.
  TensorFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, const ShapeRange& range,
               FitCheckpoint& checkpoint, Progress& progress);

  ModelBody fit(size_t point) override;

 private:
  struct Side {
    SideDirections directions;
    double energy;
    std::vector<Relief> relief;
    FoundShape found;
    uint64_t found_bytes = 0;  // budget of the search
    std::optional<DirectionBases> bases;
    std::optional<ReducedTexels> reduced;  // like `bases`, held only while something is fitted to it
    std::optional<TensorSide> fitted;      // with the best shape, if it had a rival
  };
  TensorSource source(size_t side) const;
  TensorExtent extent(size_t side) const;
  uint64_t side_bytes(size_t side, uint64_t bytes) const;
  void find_sides(const ColorAxes& colors);
  void reduce(size_t side);
  void find_shape(size_t side, uint64_t bytes, const ShapeRange& range);
  void settle_rival(size_t side);
  double error_of(const TensorSide& side);
  void set_curve(uint64_t bytes);
  std::optional<TensorShape> shape_of(size_t side, uint64_t bytes) const;
  TensorSide fit_side(size_t side, const TensorShape& shape);
  void set_clusters(size_t side, const std::string& stage, TensorSide& fitted);

  const BtfMeasurement& measurement_;
  const BtfFitOptions options_;
  TensorAllowance allowance_;
  FitCheckpoint& checkpoint_;
  Progress& progress_;
  CompandedViews views_;
  Mat3 axes_{1.0f};
  std::vector<Side> sides_;
  std::vector<SharedSide> shared_;
  std::vector<uint64_t> bytes_;  // budget per point of the curve
};

}  // namespace velour

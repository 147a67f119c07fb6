// A BTF fitted by clustered tensors.
#pragma once

#include "compress/btf_fitter.h"
#include "compress/direction_bases.h"
#include "compress/fit_checkpoint.h"
#include "compress/fit_memory.h"
#include "compress/fitted_sides.h"
#include "compress/reduced_texels.h"
#include "compress/shape_search.h"

namespace velour {

/// Of all sides of the layout: which ones are dark or alike is found by reading them.
FitSize tensor_fit_size(const BtfMeasurement& measurement, const BtfFitOptions& options);

/// Tucker, CTA and K-CTA, by the clusters and members that they may have. What some texels show, in bases of the views
/// and lights, is clustered (tensor/cluster_fit.h); how many clusters of which ranks are worth their bytes is tried
/// first; where that leaves two shapes close to each other, models of both are. Clusters are stored as half floats, and
/// the texels of every level are then solved for by what was stored.
class TensorFitter final : public BtfFitter {
 public:
  /// Both must outlive this. What the checkpoint has kept is not done again. Throws Error(invalid_argument) when the
  /// bytes hold no model, Error(unsupported) for a layout that is not complete and for too little memory.
  TensorFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, const ShapeRange& range,
               FitCheckpoint& checkpoint, Progress& progress);

  ModelBody fit(size_t point) override;

 private:
  struct Side {
    SideDirections directions;
    double energy;
    std::vector<Relief> relief;
    FoundShape found;
    uint64_t found_bytes = 0;  // that it was sought for
    std::optional<DirectionBases> bases;
    std::optional<ReducedTexels> reduced;  // both only while something is fitted to them
    std::optional<TensorSide> fitted;      // of the best shape, where it had a rival
  };
  TensorSource source(size_t side) const;
  TensorExtent extent(size_t side) const;
  uint64_t side_bytes(size_t side, uint64_t bytes) const;
  void find_sides(const ColourAxes& colours);
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
  std::vector<uint64_t> bytes_;  // of each point of the curve
};

}  // namespace velour

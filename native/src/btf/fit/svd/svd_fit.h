// Truncated singular value decomposition of a BTF.
#pragma once

#include <array>
#include "btf/fit/svd/factored_fit.h"

namespace velour {

/// One matrix of direction pairs times texels per decorrelated color axis, decomposed by randomized power iterations
/// [HMT11] and truncated to its strongest components; those of all axes compete for the bytes.
class SvdFitter final : public FactoredFitter {
 public:
  /// The arguments must outlive the fitter. Stages in the checkpoint are reused. Throws Error(invalid_argument) if the
  /// bytes do not hold a single component, Error(unsupported) for an incomplete layout or too little memory.
  SvdFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
            Progress& progress);

 private:
  /// State of the decomposition of one color axis.
  struct Sketch {
    RowMatrix basis;         // texel x column, orthonormal
    RowMatrix response;      // pair x column: the matrix times the basis
    RowMatrix image;         // texel x column: the transposed matrix times the response
    Eigen::VectorXd energy;  // per component, descending
  };

  void copy_function(const Component& component, Eigen::Ref<Eigen::VectorXf> values) const override;
  void sketch(uint64_t components, double begin, double end);
  void start(Sketch& sketch, Eigen::Index columns, size_t axis) const;
  bool take_kept_bases(const std::string& stage, Eigen::Index columns);
  void pass(bool continuation);
  void respond(Sketch& sketch, const RowMatrix& plane, uint32_t view, bool continuation) const;
  std::vector<Component> found() const;
  bool reaches(double error) const;

  std::array<Sketch, 3> sketch_;
};

// Truncated singular value decomposition of every view on its own.

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

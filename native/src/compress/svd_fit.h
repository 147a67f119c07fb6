// A BTF's truncated singular value decomposition.
#pragma once

#include <array>

#include "compress/factored_fit.h"

namespace velour {

/// One matrix of direction pairs times texels a decorrelated colour axis, found at random with power iterations [HMT11]
/// and cut to its strongest components; those of all axes compete for the bytes.
class SvdFitter final : public FactoredFitter {
 public:
  /// Both must outlive this. What the checkpoint has kept is not done again. Throws Error(invalid_argument) when the
  /// bytes hold not one component, Error(unsupported) for a layout that is not complete and for too little memory.
  SvdFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
            Progress& progress);

 private:
  /// One colour axis on its way to its components.
  struct Sketch {
    RowMatrix basis;         // texel x column, orthonormal
    RowMatrix response;      // pair x column: the matrix times the basis
    RowMatrix image;         // texel x column: the transposed matrix times the response
    Eigen::VectorXd energy;  // of each component, falling
  };

  void copy_function(const Component& component, Eigen::Ref<Eigen::VectorXf> values) const override;
  void sketch(uint64_t components, double begin, double end);
  void start(Sketch& sketch, Eigen::Index columns, size_t axis) const;
  bool take_kept_bases(const std::string& stage, Eigen::Index columns);
  void pass(bool onward);
  void respond(Sketch& sketch, const RowMatrix& plane, uint32_t view, bool onward) const;
  std::vector<Component> found() const;
  bool reaches(double error) const;

  std::array<Sketch, 3> sketch_;
};

}  // namespace velour

// A BTF's truncated singular value decomposition.
#pragma once

#include <array>

#include "compress/btf_fitter.h"
#include "compress/colour_axes.h"

namespace velour {

/// One matrix of direction pairs times texels a decorrelated colour axis, found at random with power iterations [HMT11]
/// and cut to its strongest components; those of all axes compete for the bytes. Coarse levels are projections of the
/// filtered measurement on the same functions, so they keep its mean.
class SvdFitter final : public BtfFitter {
 public:
  /// Both must outlive this. What the checkpoint has kept is not done again. Throws Error(invalid_argument) when the
  /// bytes hold not one component, Error(unsupported) for a layout that is not complete and for too little memory.
  SvdFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
            Progress& progress);

  ModelBody fit(size_t point) override;

 private:
  /// One colour axis on its way to its components.
  struct Sketch {
    RowMatrix basis;         // texel x column, orthonormal
    RowMatrix response;      // pair x column: the matrix times the basis
    RowMatrix image;         // texel x column: the transposed matrix times the response
    Eigen::VectorXd energy;  // of each component, falling
  };
  struct Component {
    uint8_t axis;
    Eigen::Index column;
    double energy;
  };
  struct Level {
    uint32_t width, height;
    RowMatrix value;      // texel x component
    double measured = 0;  // sum of the squares of companded images, times both cosines
  };

  uint64_t most_components(uint64_t bytes) const;
  void sketch(uint64_t components, double begin, double end);
  void start(Sketch& sketch, Eigen::Index columns, size_t axis) const;
  bool take_kept_bases(const std::string& stage, Eigen::Index columns);
  void pass(bool onward);
  void respond(Sketch& sketch, const RowMatrix& plane, uint32_t view, bool onward) const;
  void rank();
  void set_curve();
  bool reaches(double error) const;
  void choose(size_t components, FactoredBtf& btf);
  void project(FactoredBtf& btf);
  void project(const FactoredBtf& btf, uint32_t view, Level& level);
  double cosine(Eigen::Index pair) const;
  double modelled(const FactoredBtf& btf, const RowMatrix& value) const;

  const BtfMeasurement& measurement_;
  const BtfFitOptions options_;
  FitCheckpoint& checkpoint_;
  Progress& progress_;
  CompandedViews views_;
  uint64_t one_;    // bytes of a component
  double all_ = 0;  // sum of squares of all companded values
  Mat3 axes_{1.0f};
  std::array<Sketch, 3> sketch_;
  std::vector<Component> ranked_;  // of all axes, the strongest first
  RowMatrix function_;             // pair x component, of the fit that runs
  std::vector<float> f_;
  CompandedViews::Planes planes_;
};

}  // namespace velour

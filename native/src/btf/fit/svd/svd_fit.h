// Truncated singular value decomposition of a BTF, as a sum of products.
#pragma once

#include <array>
#include "base/parallel.h"
#include "btf/fit/btf_fitter.h"
#include "btf/fit/fitted_sides.h"
#include "btf/model/factored_btf.h"

namespace velour {

// Base of BTF fits as sums of products: choice of the components and projection of the texels.

FitSize factored_fit_size(const BtfMeasurement& measurement, const BtfFitOptions& options, bool by_view);

/// Functions of the pair are orthonormal; those with the most energy over all axes (and views) are chosen, but first
/// the strongest one of each view that has any light, if components serve one view. Coarse levels are projections of
/// the filtered measurement on the same functions, so they preserve its mean.
class FactoredFitter : public BtfFitter {
 public:
  ModelBody fit(size_t point) final;

 protected:
  struct Component {
    uint32_t view;  // view it serves; 0 if components serve all views
    uint8_t axis;
    Eigen::Index column;  // among those of its view and axis
    double energy;
  };

  /// The arguments must outlive the fitter. `by_view`: each component serves one view. Throws Error(unsupported) for
  /// incomplete layouts.
  FactoredFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
                 Progress& progress, bool by_view);

  /// Reads every view once. Throws Error(invalid_argument) if the bytes do not hold a component for every view that
  /// needs one.
  void find_axes();
  /// Byte budget: the requested size, or the method's default.
  uint64_t bytes() const;
  /// Maximum number of components to compute within the bytes and the memory limit. Throws Error(unsupported) if the
  /// memory does not suffice.
  uint64_t most_components() const;
  /// Ranks components of all axes and views, given in any order: keeps the best `most` above rounding error and sets
  /// the curve of their residuals, from the minimum number on. An axis may have unknown components weaker than those
  /// found: the curve may be too high, never too low.
  void rank(std::vector<Component> components, size_t most);
  /// Writes the values of a component's function.
  virtual void copy_function(const Component& component, Eigen::Ref<Eigen::VectorXf> values) const = 0;
  /// Sets largest().
  void bound_components();

  const BtfMeasurement& measurement_;
  const BtfFitOptions options_;
  FitCheckpoint& checkpoint_;
  Progress& progress_;
  CompandedViews views_;
  std::vector<float> f_;
  CompandedViews::Planes planes_;

 private:
  struct Level {
    uint32_t width, height;
    RowMatrix value;               // texel x component
    std::vector<double> measured;  // per group of components: squares of companded images, times both cosines
  };

  void require_least(size_t components);
  void choose(size_t components, FactoredBtf& btf);
  void project(FactoredBtf& btf);
  void project(const FactoredBtf& btf, const ComponentRanges& ranges, uint32_t view, Level& level);
  void scale_to_halves(std::vector<Level>& levels, FactoredBtf& btf);
  void brighten(const FactoredBtf& btf, const ComponentRanges& ranges, Level& level) const;
  double cosine(Eigen::Index pair) const;
  double modelled(const FactoredBtf& btf, const ComponentRanges& ranges, size_t group, const RowMatrix& value) const;

  const bool by_view_;
  const uint64_t one_;  // bytes per component
  size_t least_ = 1;    // minimum number of components
  Mat3 axes_{1.0f};
  double all_ = 0;                 // sum of squares of all companded values
  std::vector<Component> ranked_;  // best first
  RowMatrix function_;             // row x component, of the current fit
};

/// Calls work(first, count) for blocks of rows or columns of fixed size, so that sums do not depend on threads.
template <class Work>
void for_blocks(Eigen::Index extent, Eigen::Index step, int threads, const Progress& progress, const Work& work) {
  parallel_pieces(static_cast<size_t>((extent + step - 1) / step), threads, progress, [&](size_t i) {
    const Eigen::Index first = static_cast<Eigen::Index>(i) * step;
    work(first, std::min(step, extent - first));
  });
}

inline constexpr Eigen::Index kBlockRows = 16, kBlockColumns = 512;

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
  uint64_t first_sketch(uint64_t most);
  Eigen::Index columns_for(uint64_t components) const;
  void sketch(uint64_t components, double begin, double end);
  void start(Sketch& sketch, Eigen::Index columns, size_t axis) const;
  int take_kept_bases(Eigen::Index columns);
  void pass(bool continuation);
  void respond(Sketch& sketch, const RowMatrix& plane, uint32_t view, bool continuation) const;
  std::vector<Component> found() const;
  bool reaches(double error) const;

  std::array<Sketch, 3> sketch_;
};

// Truncated singular value decomposition of every view on its own.

/// One matrix of lights times texels per view and decorrelated color axis, decomposed exactly from the products of its
/// rows and truncated to its strongest components; those of all views and axes compete for the bytes beyond one for
/// each view that is not black.
class ViewSvdFitter final : public FactoredFitter {
 public:
  /// The arguments must outlive the fitter. Only the colors are checkpointed; the decompositions take one pass over the
  /// views. Throws Error(invalid_argument) if the bytes do not hold a component for every view that is not black,
  /// Error(unsupported) for an incomplete layout or too little memory.
  ViewSvdFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
                Progress& progress);

 private:
  void copy_function(const Component& component, Eigen::Ref<Eigen::VectorXf> values) const override;
  void decompose(uint32_t view, std::vector<Component>& components);

  std::vector<std::array<RowMatrix, 3>> function_of_;  // [view][axis]: light x column, orthonormal columns
};

}  // namespace velour

// Base of BTF fits as sums of products: choice of the components and projection of the texels.
#pragma once

#include "base/parallel.h"
#include "btf/fit/btf_fitter.h"
#include "btf/fit/color_axes.h"
#include "btf/fit/fit_memory.h"
#include "btf/model/factored_btf.h"

namespace velour {

FitSize factored_fit_size(const BtfMeasurement& measurement, const BtfFitOptions& options, bool by_view);

/// Functions of the pair are orthonormal; those with the most energy over all axes (and views) are chosen. Coarse
/// levels are projections of the filtered measurement on the same functions, so they preserve its mean.
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

  /// Reads every view once.
  void find_axes();
  /// Byte budget: the requested size, or the method's default.
  uint64_t bytes() const;
  /// Maximum number of components to compute within the bytes and the memory limit. Throws Error(unsupported) if the
  /// memory does not suffice.
  uint64_t most_components() const;
  /// Ranks components of all axes and views, given in any order: keeps the strongest `most` above rounding error and
  /// sets the curve of their residuals. An axis may have unknown components weaker than those found: the curve may be
  /// too high, never too low.
  void rank(std::vector<Component> components, size_t most);
  /// Writes the values of a component's function.
  virtual void copy_function(const Component& component, Eigen::Ref<Eigen::VectorXf> values) const = 0;

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

  void choose(size_t components, FactoredBtf& btf);
  void project(FactoredBtf& btf);
  void project(const FactoredBtf& btf, const ComponentRanges& ranges, uint32_t view, Level& level);
  void brighten(const FactoredBtf& btf, const ComponentRanges& ranges, Level& level) const;
  double cosine(Eigen::Index pair) const;
  double modelled(const FactoredBtf& btf, const ComponentRanges& ranges, size_t group, const RowMatrix& value) const;

  const bool by_view_;
  const uint64_t one_;  // bytes per component
  Mat3 axes_{1.0f};
  double all_ = 0;                 // sum of squares of all companded values
  std::vector<Component> ranked_;  // strongest first
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

}  // namespace velour

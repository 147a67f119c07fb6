// What fits of BTFs as sums of products share: which components are worth their bytes, and the texels' part of them.
#pragma once

#include "btf/component_ranges.h"
#include "compress/btf_fitter.h"
#include "compress/colour_axes.h"
#include "compress/fit_memory.h"
#include "job/parallel.h"

namespace velour {

FitSize factored_fit_size(const BtfMeasurement& measurement, const BtfFitOptions& options, bool by_view);

/// Functions of the pair are orthonormal, of all axes (and views) those of the most energy are chosen. Coarse levels
/// are projections of the filtered measurement on the same functions, so they keep its mean.
class FactoredFitter : public BtfFitter {
 public:
  ModelBody fit(size_t point) final;

 protected:
  struct Component {
    uint32_t view;  // that it serves; 0 where all serve all
    uint8_t axis;
    Eigen::Index column;  // among those of the view and the axis
    double energy;
  };

  /// Arguments must outlive this. `by_view`: a component serves one view. Throws Error(unsupported) for a layout that
  /// is not complete.
  FactoredFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
                 Progress& progress, bool by_view);

  /// Reads every view once.
  void find_axes();
  /// What may be spent: what was asked for, or the method's usual part.
  uint64_t bytes() const;
  /// How many components are looked at: within the bytes, and within the memory that was allowed. Throws
  /// Error(unsupported) where that is too little.
  uint64_t most_components() const;
  /// Of all axes and views, in any order: the strongest that are more than rounding, and the curve of what they leave.
  /// Beyond the weakest one of an axis that was found there may be unknown ones: there the curve is too high, never too
  /// low.
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
    std::vector<double> measured;  // a group of components: squares of companded images, times both cosines
  };

  void choose(size_t components, FactoredBtf& btf);
  void project(FactoredBtf& btf);
  void project(const FactoredBtf& btf, const ComponentRanges& ranges, uint32_t view, Level& level);
  void brighten(const FactoredBtf& btf, const ComponentRanges& ranges, Level& level) const;
  double cosine(Eigen::Index pair) const;
  double modelled(const FactoredBtf& btf, const ComponentRanges& ranges, size_t group, const RowMatrix& value) const;

  const bool by_view_;
  const uint64_t one_;  // bytes of a component
  Mat3 axes_{1.0f};
  double all_ = 0;                 // sum of squares of all companded values
  std::vector<Component> ranked_;  // the strongest first
  RowMatrix function_;             // row x component, of the fit that runs
};

/// Work over blocks of rows or columns: fixed, so that sums do not depend on threads.
template <class Work>
void for_blocks(Eigen::Index extent, Eigen::Index step, int threads, const Progress& progress, const Work& work) {
  parallel_pieces(static_cast<size_t>((extent + step - 1) / step), threads, progress, [&](size_t i) {
    const Eigen::Index first = static_cast<Eigen::Index>(i) * step;
    work(first, std::min(step, extent - first));
  });
}

inline constexpr Eigen::Index kBlockRows = 16, kBlockColumns = 512;

}  // namespace velour

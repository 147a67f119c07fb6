// The Principled material as a least-squares problem over pairs of directions.
#pragma once

#include <array>
#include <vector>

#include "fit/levenberg_marquardt.h"
#include "fit/pair_samples.h"
#include "fit/principled_fit.h"
#include "material/principled_point.h"
#include "sphere/direction_batch.h"

namespace velour {

/// Minimises sum_i weight_i |g(model_i) - g(f_cos_i)|^2 over colours, g(y) = sqrt(y + floor), parameters in [0, 1].
class PrincipledProblem {
 public:
  /// Unknowns: base colour, specular tint, then those of kShape.
  static constexpr int kSize = 11;
  using Normal = NormalEquations<kSize>;
  static constexpr std::array<float PrincipledParameters::*, 5> kShape{
      &PrincipledParameters::metallic, &PrincipledParameters::roughness, &PrincipledParameters::specular,
      &PrincipledParameters::coat, &PrincipledParameters::coat_roughness};

  explicit PrincipledProblem(PairSamples samples, PrincipledSet set = PrincipledSet::all);

  double cost(const PrincipledParameters& p) const;
  /// Derivatives are differences.
  Normal normal(const PrincipledParameters& p) const;
  PrincipledParameters moved(const PrincipledParameters& p, const decltype(Normal::slope)& step) const;
  /// With the base colour that suits the rest: least squares of the problem linearised at the data, f taken for linear
  /// in the colour.
  PrincipledParameters completed(const PrincipledParameters& start) const;

 private:
  /// Samples of one view.
  struct Batch {
    Vec3 wv;
    size_t first;  // of samples_
    DirectionBatch wl;
  };
  /// f cos at each sample.
  std::vector<Rgb> values(const PrincipledParameters& p) const;
  /// Whether the set leaves an unknown where it is.
  bool is_fixed(Eigen::Index unknown) const;
  void freeze_at_bounds(const PrincipledParameters& p, Normal& n) const;

  std::vector<PairSample> samples_;
  std::vector<Batch> batches_;
  float floor_;
  PrincipledSet set_;
};

}  // namespace velour

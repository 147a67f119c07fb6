// The Principled material as a least-squares problem over pairs of directions.
#pragma once

#include <array>
#include <vector>

#include "fit/levenberg_marquardt.h"
#include "fit/pair_samples.h"
#include "fit/principled_fit.h"
#include "material/principled_lobes.h"

namespace velour {

/// Minimises sum_i weight_i |g(model_i) - g(f_cos_i)|^2 over colours, g(y) = sqrt(y + floor), parameters in [0, 1].
class PrincipledProblem {
 public:
  /// Unknowns: base colour, specular tint, then those of kShape.
  static constexpr int kSize = 11;
  using Normal = NormalEquations<kSize>;
  /// What f depends on through tables of albedos: derivatives by differences.
  static constexpr std::array<float PrincipledParameters::*, 5> kShape{
      &PrincipledParameters::metallic, &PrincipledParameters::roughness, &PrincipledParameters::specular,
      &PrincipledParameters::coat, &PrincipledParameters::coat_roughness};

  explicit PrincipledProblem(PairSamples samples, PrincipledSet set = PrincipledSet::all);

  double cost(const PrincipledParameters& p) const;
  Normal normal(const PrincipledParameters& p) const;
  PrincipledParameters moved(const PrincipledParameters& p, const decltype(Normal::slope)& step) const;
  /// With the base colour that suits the rest: least squares of the problem linearised at the data.
  PrincipledParameters completed(const PrincipledParameters& start) const;

 private:
  using Parts = PrincipledLobes::Parts;
  /// Of f at each sample.
  std::vector<Parts> parts(const PrincipledLobes& lobes) const;
  /// The parts beside `p` by difference_of each of kShape.
  std::array<std::vector<Parts>, kShape.size()> parts_beside(const PrincipledParameters& p,
                                                             const PrincipledLobes& lobes) const;
  void freeze_at_bounds(const PrincipledParameters& p, Normal& n) const;
  /// What is not in the set.
  void freeze_others(Normal& n) const;

  std::vector<PairSample> samples_;
  std::vector<Vec3> h_;
  float floor_;
  PrincipledSet set_;
};

}  // namespace velour

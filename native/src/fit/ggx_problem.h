// Levenberg-Marquardt on the parameters of a GGX lobe over a diffuse base, for samples of f cos.
#pragma once

#include <vector>

#include "fit/levenberg_marquardt.h"
#include "fit/pair_samples.h"
#include "material/ggx_sampler.h"

namespace velour {

/// Minimizes sum_i weight_i |g(model_i) - g(f_cos_i)|^2, the norm over channels, with g(y) = sqrt(y + floor).
class GgxProblem {
 public:
  /// Unknowns: log alpha (one if isotropic, otherwise two), then three per channel.
  using Normal = NormalEquations<11>;
  static constexpr float kLargestAlpha = 2;

  GgxProblem(PairSamples samples, bool isotropic);

  double cost(const GgxParameters& p) const;
  Normal normal(const GgxParameters& p) const;
  /// Changes log alpha by at most 1 and keeps reflectances non-negative.
  GgxParameters moved(const GgxParameters& p, const decltype(Normal::slope)& step) const;
  /// `start` with the best reflectances for its alpha: non-negative least squares, linearized at the data.
  GgxParameters completed(const GgxParameters& start) const;

 private:
  struct Basis {  // f cos = diffuse base + f0 normal + f90 grazing
    float base, normal, grazing;
  };
  struct Geometry {
    Vec3 h;
    float schlick;
  };

  int alphas() const { return isotropic_ ? 1 : 2; }
  Basis basis(size_t i, const Vec2& alpha) const;
  void freeze_at_zero(const GgxParameters& p, Normal& n) const;

  std::vector<PairSample> samples_;
  std::vector<Geometry> geometry_;
  float floor_;
  bool isotropic_;
};

}  // namespace velour

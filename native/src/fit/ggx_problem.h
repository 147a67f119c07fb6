// Levenberg-Marquardt on the parameters of a GGX lobe over a diffuse base, for samples of f cos.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "material/ggx_sampler.h"

namespace velour {

/// One pair of directions, both above the horizon.
struct GgxSample {
  DirectionPair w;
  Rgb f_cos;     // >= 0
  float weight;  // >= 0
};

/// Minimises sum_i weight_i |g(model_i) - g(f_cos_i)|^2 over colours, g(y) = sqrt(y + floor).
class GgxProblem {
 public:
  /// `floor` > 0: what f cos is indistinguishable from 0.
  GgxProblem(std::vector<GgxSample> samples, float floor, bool isotropic);

  double cost(const GgxParameters& p) const;
  /// The reflectances that suit `alpha`: non-negative least squares of the problem linearised at the data.
  GgxParameters reflectances(const Vec2& alpha) const;
  /// Descends from `p`; `check` is called once a step.
  GgxParameters polish(GgxParameters p, const std::function<void()>& check) const;

  static constexpr float kLargestAlpha = 2;

 private:
  static constexpr int kMost = 11;  // unknowns: log alpha (one when isotropic, else two), then three a colour
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMost, kMost>;
  using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMost, 1>;
  struct Normal {  // of the Gauss-Newton model: curvature step = -slope
    Matrix curvature;
    Vector slope;
  };
  struct Basis {  // f cos = diffuse base + f0 normal + f90 grazing
    float base, normal, grazing;
  };
  struct Geometry {
    Vec3 h;
    float schlick;
  };

  int alphas() const { return isotropic_ ? 1 : 2; }
  Basis basis(size_t i, const Vec2& alpha) const;
  Normal normal(const GgxParameters& p) const;
  GgxParameters moved(const GgxParameters& p, const Vector& step) const;
  void freeze_at_zero(const GgxParameters& p, Normal& n) const;

  std::vector<GgxSample> samples_;
  std::vector<Geometry> geometry_;
  float floor_;
  bool isotropic_;
};

}  // namespace velour

// Fits a GGX lobe over a diffuse base to a measured material, as a renderer without Velour would use.
#pragma once

#include <vector>
#include "base/progress.h"
#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "material/microfacet/ggx_sampler.h"
#include "math/optimize/levenberg_marquardt.h"

namespace velour {

// Samples of a material for the fits of analytic materials: pairs of directions, weighted by their share in a picture.

/// One pair of directions, both above the horizon.
struct PairSample {
  DirectionPair w;
  Rgb f_cos;     // >= 0
  float weight;  // >= 0
};

struct PairSamples {
  std::vector<PairSample> samples;  // empty if all are black
  float floor = 0;  // f cos hardly distinguishable from 0: a thousandth of its mean; > 0 if there are samples
};

/// 18 views (72 if f depends on the azimuth) in the middles of 5-degree intervals, none within the margin of a held-out
/// one, with 32 x 16 half vectors each. Held-out irregular samples are not read. A view has the weight
/// sin(2 theta_v) / albedo, its share in the picture of a sphere. The result does not depend on `threads` (0: all).
PairSamples pair_samples(const Material& material, int threads, Progress& progress);
PairSamples pair_samples(const Measurement& measurement, int threads, Progress& progress);

/// Least squares on sqrt(f cos) over the pair_samples of the material. With the density q = f cos / albedo of the
/// material and the density p of the fit, this is their Hellinger distance: to second order a quarter of their
/// chi-square distance, which is the relative variance of an estimate of the albedo with samples of p. Starting values
/// of the roughness scan its whole range (ten log-spaced values, times five aspect ratios if f depends on the azimuth
/// of the view), with reflectances by non-negative least squares; the three best starts are refined by
/// Levenberg-Marquardt. Axes are those of the frame. The result does not depend on `threads` (0: all). Black if there
/// are no samples.
GgxParameters fit_ggx(const Material& material, int threads, Progress& progress);
GgxParameters fit_ggx(const Measurement& measurement, int threads, Progress& progress);

// Levenberg-Marquardt on the parameters of a GGX lobe over a diffuse base, for samples of f cos.

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

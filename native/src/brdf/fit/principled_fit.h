// Fits the Principled material to a measurement: the best that an artist could set by hand.
#pragma once

#include <array>
#include <vector>
#include "base/progress.h"
#include "brdf/fit/pair_samples.h"
#include "brdf/measure/measurement.h"
#include "material/principled/principled_point.h"
#include "math/optimize/levenberg_marquardt.h"
#include "math/sphere/directions.h"

namespace velour {

/// Parameters of the Principled material that a fit may use.
enum class PrincipledSet {
  all,
  plain,  // base color, metallic, roughness and specular, which Blender before 4.0 and other programs also have
};

/// Least squares on sqrt(f cos) over the pair_samples of the measurement, as in fit_ggx. Starts: eight kinds (plain:
/// four) between dielectric and metal, bare and coated, each at eight roughnesses over the range, with the best base
/// color. The best roughness of each kind is refined by Levenberg-Marquardt. PrincipledSet::plain has white tints and
/// no coat. The result does not depend on `threads` (0: all). Black and diffuse if there are no samples.
PrincipledParameters fit_principled(const Measurement& measurement, PrincipledSet set, int threads, Progress& progress);

// The Principled material as a least-squares problem over pairs of directions.

/// Minimizes sum_i weight_i |g(model_i) - g(f_cos_i)|^2, the norm over channels, with g(y) = sqrt(y + floor) and
/// parameters in [0, 1].
class PrincipledProblem {
 public:
  /// Unknowns: base color, specular tint, then those of kShape.
  static constexpr int kSize = 11;
  using Normal = NormalEquations<kSize>;
  static constexpr std::array<float PrincipledParameters::*, 5> kShape{
      &PrincipledParameters::metallic, &PrincipledParameters::roughness, &PrincipledParameters::specular,
      &PrincipledParameters::coat, &PrincipledParameters::coat_roughness};

  explicit PrincipledProblem(PairSamples samples, PrincipledSet set = PrincipledSet::all);

  double cost(const PrincipledParameters& p) const;
  /// Derivatives are finite differences.
  Normal normal(const PrincipledParameters& p) const;
  PrincipledParameters moved(const PrincipledParameters& p, const decltype(Normal::slope)& step) const;
  /// `start` with the best base color: least squares, linearized at the data, with f assumed linear in the color.
  PrincipledParameters completed(const PrincipledParameters& start) const;

 private:
  /// Samples of one view.
  struct Batch {
    Vec3 wv;
    size_t first;  // index in samples_
    DirectionBatch wl;
  };
  /// f cos at each sample.
  std::vector<Rgb> values(const PrincipledParameters& p) const;
  /// Whether `unknown` is fixed, because it is not in the set.
  bool is_fixed(Eigen::Index unknown) const;
  void freeze_at_bounds(const PrincipledParameters& p, Normal& n) const;

  std::vector<PairSample> samples_;
  std::vector<Batch> batches_;
  float floor_;
  PrincipledSet set_;
};

}  // namespace velour

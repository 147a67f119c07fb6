// Analytic materials to compare a fitted model with: fitted to the same measurement and judged in the same way.
#pragma once

#include <array>
#include <memory>
#include <variant>
#include <vector>
#include "base/progress.h"
#include "brdf/fit/error/compare.h"
#include "brdf/fit/ggx_fit.h"
#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "material/microfacet/ggx_sampler.h"
#include "material/principled/principled_material.h"
#include "math/optimize/levenberg_marquardt.h"
#include "math/sphere/directions.h"

namespace velour {

// Fits the Principled material to a measurement: the best that an artist could set by hand.

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

enum class Peer { ggx, principled, plain_principled };
using PeerParameters = std::variant<GgxParameters, PrincipledParameters>;

/// The peer with the parameters that fit the measurement best. The result does not depend on `threads` (0: all).
PeerParameters fit_peer(const Measurement& measurement, Peer peer, int threads, Progress& progress);

std::shared_ptr<const Material> make_peer_material(const PeerParameters& parameters);

/// A fitted peer, and its error as docs/engine/conventions.md defines it for any model.
struct PeerFit {
  PeerParameters parameters;
  double seconds = 0;  // of the fit
  Comparison error;

  /// Bytes of the parameter struct.
  uint64_t parameter_bytes() const;
};
PeerFit judge_peer(const Measurement& measurement, Peer peer, int threads, Progress& progress);

}  // namespace velour

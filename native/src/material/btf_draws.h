// Sampling mixture of a BTF model.
#pragma once

#include <array>
#include <vector>

#include "srbf/lobe_products.h"
#include "srbf/warped_mixture.h"

namespace velour {

/// Appearance of a BTF point, as far as the sampling mixture depends on it.
struct BtfLook {
  static constexpr size_t kBroad = 7;
  Vec3 wv, normal;
  std::array<float, kBroad> broad;  // luminance of f cos at BtfDraws::centers()
  float mirror;                     // luminance of f cos in the mirror direction about `normal`
};

/// A BTF's f is a square of signed sums, which cannot be sampled in closed form but is cheap to evaluate. Each point
/// therefore gets its own mixture: seven broad lobes over the hemisphere, as strong as f cos at their centers (which
/// includes shadows and the slope of the relief); a half-vector lobe about the relief normal, as strong as f cos in the
/// mirror direction exceeds the broad lobes; and the cosine. It adds no bytes to the model and follows every texel.
/// Densities are exact; only their fit is rough. Immutable; thread-safe.
class BtfDraws {
 public:
  /// A point and a view, with the luminance of f cos at each of even_lights().
  struct Example {
    BtfLook look;
    std::vector<float> f;
  };
  /// Cosine-distributed light directions.
  static const std::vector<Vec3>& even_lights();
  /// Chooses the bandwidth of the half-vector lobe and the cosine share from a few candidates, by least variance under
  /// uniform light over `examples`. Cosine sampling alone is best for a diffuse surface without shadows.
  explicit BtfDraws(const std::vector<Example>& examples);

  static const std::array<Vec3, BtfLook::kBroad>& centers();
  /// False: plain cosine sampling; only `wv` and `normal` of a look are used.
  bool asks() const { return cosine_share_ < 1; }
  /// Whether BtfLook::mirror is used; it must then be evaluated at mirror().
  bool asks_mirror(const Vec3& wv, const Vec3& normal) const;
  static Vec3 mirror(const Vec3& wv, const Vec3& normal) { return 2 * glm::dot(wv, normal) * normal - wv; }

  /// Sets the density of `mixture`, and its value to 0. No allocation.
  void fill(const BtfLook& look, WarpedMixture& mixture) const;
  /// The lobes of `mixture` as Gaussians over light directions.
  static void propose(const WarpedMixture& mixture, ProposalLobes& lobes);

 private:
  float half_bandwidth_ = 0, cosine_share_ = 1;
};

}  // namespace velour

// What samples of a BTF's model are drawn from.
#pragma once

#include <array>
#include <vector>

#include "srbf/lobe_products.h"
#include "srbf/warped_mixture.h"

namespace velour {

/// What a point of a BTF looks like to whoever draws lights for it.
struct BtfLook {
  static constexpr size_t kBroad = 7;
  Vec3 wv, normal;
  std::array<float, kBroad> broad;  // f cos, luminance, at BtfDraws::centers()
  float mirror;                     // the same in the mirror direction about the normal
};

/// A BTF's f is a square of signed sums, which nothing draws from in closed form; but it is quickly asked for. So each
/// point has a mixture of its own: seven broad lobes over the hemisphere, as strong as f cos is at their centres
/// (shadows and the slope of the relief are in it), a lobe of the half vector about the relief's normal, as strong as f
/// cos in the mirror direction stands out of those, and the cosine. It takes no bytes of the model, and follows every
/// texel. The densities are exact; only their fit is rough. Immutable; thread-safe.
class BtfDraws {
 public:
  /// A place and a view, with f cos of luminance at each of even_lights().
  struct Example {
    BtfLook look;
    std::vector<float> f;
  };
  /// Spread by the cosine.
  static const std::vector<Vec3>& even_lights();
  /// Chooses the bandwidth of the half vector's lobe and the share of the cosine, which alone is best for a diffuse
  /// surface without shadows: of a few, those of the least variance under even light over `examples`.
  explicit BtfDraws(const std::vector<Example>& examples);

  static const std::array<Vec3, BtfLook::kBroad>& centers();
  /// False: samples are the cosine's, and nothing but wv and normal of a look is used.
  bool asks() const { return cosine_share_ < 1; }
  /// Whether a look's `mirror` is used; then it is at mirror().
  bool asks_mirror(const Vec3& wv, const Vec3& normal) const;
  static Vec3 mirror(const Vec3& wv, const Vec3& normal) { return 2 * glm::dot(wv, normal) * normal - wv; }

  /// Fills the density of `mixture`; its value is 0. No allocation.
  void fill(const BtfLook& look, WarpedMixture& mixture) const;
  /// The same lobes over light directions.
  static void propose(const WarpedMixture& mixture, ProposalLobes& lobes);

 private:
  float half_bandwidth_ = 0, cosine_share_ = 1;
};

}  // namespace velour

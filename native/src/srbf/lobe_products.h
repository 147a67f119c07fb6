// Products of Gaussian lobes: one lobe with many, their masses first, the best of them as a sampling density.
//
// The pointwise product of two Gaussians is a Gaussian (method 2.2, [T06]; kernel.h gaussian_product is the scalar
// reference in double). So BRDF lobes times light lobes are lobes again, which are drawn from in closed form [T08].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "srbf/lobe_mixture.h"

namespace velour {

/// One Gaussian: amplitude exp(-bandwidth |w - center|^2 / 2).
struct GaussianLobe {
  Vec3 center;  // unit
  float bandwidth;
  float amplitude;
};

/// Many Gaussians, structure of arrays.
struct GaussianLobes {
  std::vector<float> x, y, z, bandwidth, amplitude;
  size_t size() const { return x.size(); }
  void add(const GaussianLobe& lobe);
};

/// What resembles f cos at a shading point closely enough to steer sampling: few Gaussians (light space, local frame)
/// over a clipped cosine. Amplitudes are luminances.
struct ProposalLobes {
  static constexpr int kCapacity = 8;
  float cosine = 0;  // coefficient of max(w.z, 0)
  int count = 0;
  GaussianLobe lobe[kCapacity];
};

/// Lobes that are multiplied with one at once. They lie together, for what is looked up at a shading point comes from
/// memory that no other needs.
struct alignas(64) LobeBlock {
  static constexpr size_t kSize = 16;
  float x[kSize], y[kSize], z[kSize], bandwidth[kSize], amplitude[kSize];

  /// All lobes have amplitude 0.
  LobeBlock();
  void set(size_t place, const GaussianLobe& lobe);
};

/// All of `lobes`, in order; lobes of amplitude 0 fill the last block up.
std::vector<LobeBlock> in_blocks(const GaussianLobes& lobes);

/// The products of the lobes of a shading point, before the best are chosen. Scratch memory of a thread.
struct alignas(64) LobeProducts {
  static constexpr int kLanes = LobeBlock::kSize;
  static constexpr int kCapacity = 432;
  int count = 0;  // a multiple of kLanes
  /// Integral of the product over the sphere, times an estimate of its share above the horizon.
  float mass[kCapacity];
  float x[kCapacity], y[kCapacity], z[kCapacity];  // centres, unit; like bandwidths anything where there is no mass
  float bandwidth[kCapacity];
};

/// Appends the products of `lobe` with `others`. With a `normal`, masses count what lies above its horizon, a logistic
/// estimate: it steers the choice and normalises nothing. Callers keep to kCapacity.
void multiply_lobes(const GaussianLobe& lobe, std::span<const LobeBlock> others, const Vec3* normal,
                    LobeProducts& products);

/// Makes `mixture` the density over all products that hold at least `least` of the whole mass (over the best one where
/// none does), each in proportion to its mass. False when no product has mass: `mixture` then is not to be used.
bool keep_products(const LobeProducts& products, float least, LobeMixture& mixture);

}  // namespace velour

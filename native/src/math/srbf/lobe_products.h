// Products of one Gaussian lobe with many, and a sampling density over those of the largest mass.
//
// The pointwise product of two Gaussians is a Gaussian (method 2.2, [T06]; kernel.h gaussian_product is the scalar
// reference in double). So BRDF lobes times light lobes are lobes again and can be sampled in closed form [T08].
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/srbf/lobe_mixture.h"

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

/// Approximation of f cos at a shading point for guiding samples: a few Gaussians (light space, local frame) plus a
/// clipped cosine. Amplitudes are luminances.
struct ProposalLobes {
  static constexpr int kCapacity = 8;
  float cosine = 0;  // coefficient of max(w.z, 0)
  int count = 0;
  GaussianLobe lobe[kCapacity];
};

/// Lobes that are multiplied with another one together. They are contiguous because each shading point reads memory
/// that no other has brought into the cache.
struct alignas(64) LobeBlock {
  static constexpr size_t kSize = 16;
  float x[kSize], y[kSize], z[kSize], bandwidth[kSize], amplitude[kSize];

  /// Initializes all lobes to amplitude 0.
  LobeBlock();
  void set(size_t place, const GaussianLobe& lobe);
};

/// Splits `lobes` into blocks, in order; lobes of amplitude 0 pad the last block.
std::vector<LobeBlock> in_blocks(const GaussianLobes& lobes);

/// The products of the lobes of a shading point, before the best are chosen. Per-thread scratch memory.
struct alignas(64) LobeProducts {
  static constexpr int kLanes = LobeBlock::kSize;
  static constexpr int kCapacity = 432;
  int count = 0;  // a multiple of kLanes
  /// Integral of the product over the sphere, times an estimate of its share above the horizon.
  float mass[kCapacity];
  float x[kCapacity], y[kCapacity], z[kCapacity];  // centers, unit; unspecified, like bandwidths, where mass is 0
  float bandwidth[kCapacity];
};

/// Appends the products of `lobe` with `others`. With a `normal`, masses include a logistic estimate of the share above
/// its horizon, which guides the choice but normalizes nothing. Callers must not exceed kCapacity (asserted).
void multiply_lobes(const GaussianLobe& lobe, std::span<const LobeBlock> others, const Vec3* normal,
                    LobeProducts& products);

/// Sets `mixture` to the density over all products that have at least the share `least` of the total mass (over the
/// best one if none has), each in proportion to its mass. Returns false if the total mass is negligible or not finite;
/// `mixture` must not be used then.
bool keep_products(const LobeProducts& products, float least, LobeMixture& mixture);

}  // namespace velour

// Product sampling: the lobes of a prepared BRDF times the lobes of the sky, as one density [T08]; method 6.6.
#pragma once

#include "scene/sky_mixture.h"
#include "sphere/frame.h"
#include "srbf/lobe_products.h"

namespace velour {

/// Immutable; thread-safe; propose() allocates nothing.
///
/// Hundreds of sky lobes stay affordable because a lobe of the BRDF meets but few of them: which ones, is tabulated by
/// its direction (octahedral cells) and bandwidth (powers of four). A table's list holds the sky lobes of the largest
/// products, so what it leaves out costs variance alone: the density is that of the products that were kept, exactly,
/// and other strategies always stand beside it.
class SkyProposals {
 public:
  /// Broad lobes of the BRDF (below kFirstFine) meet most of the sky: their products are taken with `coarse`, which
  /// covers all of it in no more than kListed lobes, those of the others with `fine`.
  SkyProposals(const SkyMixture& fine, const SkyMixture& coarse);
  static constexpr int kListed = 32;  // sky lobes of a list

  /// The density, in the world frame, of the products of `brdf` (Gaussian lobes of f cos in `frame`, light space; its
  /// cosine part as the Gaussian that resembles it) with the sky. False when there is none: below the horizon, or
  /// black.
  bool propose(const LobeMixture& brdf, const Frame& frame, LobeProducts& scratch, LobeMixture& density) const;

 private:
  void fill_list(size_t list, const GaussianLobes& sky, LobeProducts& scratch);
  void multiply(const GaussianLobe& world, const Frame& frame, LobeProducts& products) const;
  static constexpr int kSide = 32;      // cells of five degrees or so
  static constexpr int kLevels = 9;     // bandwidths 1, 4, ... 4^8
  static constexpr int kFirstFine = 2;  // level
  static constexpr size_t kMostFine = 512;

  GaussianLobes lists_;          // kListed places a list, by cell, then level; of amplitude 0 where a list is shorter
  std::vector<uint8_t> listed_;  // of each list, a multiple of LobeProducts::kLanes
};

}  // namespace velour

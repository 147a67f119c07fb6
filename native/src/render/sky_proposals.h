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
  void fill_list(int cell, int level, LobeProducts& scratch);
  void multiply(const GaussianLobe& world, const Frame& frame, LobeProducts& products) const;
  const int32_t* list(int cell, int level) const {
    return &lists_[static_cast<size_t>(cell * kLevels + level) * kListed];
  }

  static constexpr int kSide = 32;      // cells of five degrees or so
  static constexpr int kLevels = 9;     // bandwidths 1, 4, ... 4^8
  static constexpr int kFirstFine = 2;  // level
  static constexpr size_t kMostFine = 512;

  void add(const SkyMixture& sky, size_t most);

  GaussianLobes sky_;            // coarse, then fine; the last one is empty: what fills lists up
  int coarse_ = 0;               // how many of them are coarse
  std::vector<int32_t> lists_;   // by cell, then level
  std::vector<uint8_t> listed_;  // of each list, a multiple of LobeProducts::kLanes
};

}  // namespace velour

// Product sampling: lobes of a prepared BRDF times lobes of the environment, as one density [T08]; method 6.6.
#pragma once

#include <optional>
#include <vector>

#include "scene/sky_mixture.h"
#include "sphere/frame.h"
#include "srbf/lobe_products.h"
#include "srbf/lobe_tree.h"

namespace velour {

/// Immutable; thread-safe; propose() allocates nothing.
///
/// Hundreds of environment lobes stay affordable because a BRDF lobe sees most of them as few: for every direction
/// (octahedral cells) and bandwidth (powers of four) of such a lobe, a cut through the tree of environment lobes is
/// kept, fine where that lobe is and coarse elsewhere. A cut represents the whole environment, so no light is left to
/// the other techniques alone; its accuracy affects only the variance.
///
/// The exception is a sun, a narrow lobe with most of the environment's energy. Its disk has an edge and a Gaussian has
/// none, so many samples from its products miss it, while light sampling samples its texels exactly and concentrates on
/// them. Where the BRDF lobe is far broader than the sun, their product is left to light sampling, which gets a larger
/// share under such an environment (lights_part.h).
class SkyProposals {
 public:
  /// `misfit`: of the mixture to its environment (sky_misfit.h).
  explicit SkyProposals(const SkyMixture& sky, double misfit = 0);
  static constexpr int kListed = 32;  // maximum number of nodes of a cut

  /// World-space density of the products of `brdf` (in `frame`) with the environment; the cosine part of `brdf` is
  /// represented by a similar Gaussian. False if there is none: below the horizon, or black.
  bool propose(const ProposalLobes& brdf, const Frame& frame, LobeProducts& scratch, LobeMixture& density) const;

  bool has_sun() const { return sun_.has_value(); }
  /// Whether lights have edges that the mixture lacks.
  bool blurs_edges() const { return blurs_edges_; }

 private:
  void fill_list(size_t list, const LobeTree& tree);
  size_t list_of(const GaussianLobe& world) const;
  void multiply(const GaussianLobe& world, size_t list, const Vec3& normal, LobeProducts& products) const;
  void set_sun(GaussianLobes& sky);
  static constexpr int kSide = 32;   // cells of about five degrees
  static constexpr int kLevels = 9;  // bandwidths 1, 4, ... 4^8

  static constexpr int kBlocks = kListed / LobeBlock::kSize;

  std::vector<LobeBlock> lists_;  // kBlocks per list, by cell, then level
  std::vector<uint8_t> blocks_;   // number of nonempty blocks, by list
  std::optional<LobeBlock> sun_;
  const bool blurs_edges_;
};

}  // namespace velour

// Product sampling: the lobes of a prepared BRDF times the lobes of the sky, as one density [T08]; method 6.6.
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
/// Hundreds of sky lobes stay affordable because a lobe of the BRDF sees most of them as few: for every direction
/// (octahedral cells) and bandwidth (powers of four) of such a lobe a cut through the tree of sky lobes is kept, fine
/// where that lobe is and coarse elsewhere. A cut stands for the whole sky, so no light is left to the other strategies
/// alone; how well it tells the light costs variance only.
///
/// One exception: a sun, a narrow lobe with most of the sky's energy. Its disk has an edge and a Gaussian has
/// none, so many draws from its products miss it, while the density of the lights draws its texels exactly and is
/// mostly about it. Where the BRDF's lobe is far broader than the sun, their product is left to the lights, which get a
/// larger share under such a sky (lights_part.h).
class SkyProposals {
 public:
  /// `misfit`: of the mixture to its sky (sky_misfit.h).
  explicit SkyProposals(const SkyMixture& sky, double misfit = 0);
  static constexpr int kListed = 32;  // nodes of a cut, at most

  /// The density, in the world frame, of the products of `brdf` (in `frame`) with the sky; its cosine part counts as
  /// the Gaussian that resembles it. False when there is none: below the horizon, or black.
  bool propose(const ProposalLobes& brdf, const Frame& frame, LobeProducts& scratch, LobeMixture& density) const;

  bool has_sun() const { return sun_.has_value(); }
  /// Whether lamps have edges that the mixture has not.
  bool blurs_edges() const { return blurs_edges_; }

 private:
  void fill_list(size_t list, const LobeTree& tree);
  size_t list_of(const GaussianLobe& world) const;
  void multiply(const GaussianLobe& world, size_t list, const Vec3& normal, LobeProducts& products) const;
  void set_sun(GaussianLobes& sky);
  static constexpr int kSide = 32;   // cells of five degrees or so
  static constexpr int kLevels = 9;  // bandwidths 1, 4, ... 4^8

  static constexpr int kBlocks = kListed / LobeBlock::kSize;

  std::vector<LobeBlock> lists_;  // kBlocks a list, by cell, then level
  std::vector<uint8_t> blocks_;   // of each list, those that hold anything
  std::optional<LobeBlock> sun_;
  const bool blurs_edges_;
};

}  // namespace velour

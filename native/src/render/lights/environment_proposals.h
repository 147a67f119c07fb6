// Product sampling: lobes of a prepared BRDF times lobes of the environment, as one density [T08]; method 6.6.
#pragma once

#include <optional>
#include <vector>
#include "light/environment_mixture.h"
#include "math/sphere/frame.h"
#include "math/srbf/lobe_products.h"
#include "math/srbf/lobe_tree.h"
#include "scene/scene.h"

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
/// share under such an environment (see lights_parts() below).
class EnvironmentProposals {
 public:
  /// `misfit`: of the mixture to its environment.
  explicit EnvironmentProposals(const EnvironmentMixture& sky, double misfit = 0);
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

// Materials for which `product` samples lights instead of products of lobes.

class EnvironmentProposals;

/// Share of the products' directions (kProductShare) that light sampling takes over, by material: half, or nothing. The
/// same at all vertices of a material, since the points of a sequence stay even only if all vertices deal them alike.
///
/// Under a sun it is half for all materials; EnvironmentProposals says why. Studio lights are the same at a smaller
/// scale: a mixture of few Gaussians blurs their edges. A highlight blurs them as well, so that its products lose
/// nothing. A diffuse material resolves them, and there light sampling, with one smooth map of the unit square, does
/// better for half of the directions.
std::vector<float> lights_parts(const Scene& scene, const EnvironmentProposals& sky);

/// Share of the reflection of uniform light, according to the material's proposals, that is in lobes as broad as a
/// cosine; mean over views. 0 if it has no lobes.
double broad_share(const Material& material);

}  // namespace velour

// What samples of a BTF of multivariate SRBFs are drawn from.
#pragma once

#include "btf/srbf_evaluator.h"
#include "srbf/lobe_products.h"
#include "srbf/warped_mixture.h"

namespace velour {

/// f is a square of signed sums, which nothing draws from in closed form; but it is quickly asked for. So each point
/// has a mixture of its own: seven broad lobes over the hemisphere, as strong as f cos is at their centres (shadows and
/// the slope of the relief are in it), a lobe of the half vector about the relief's normal, as strong as f cos in the
/// mirror direction stands out of those, and the cosine. The densities are exact; only their fit is rough. Immutable;
/// thread-safe.
class SrbfBtfDraws {
 public:
  /// Chooses the bandwidth of the half vector's lobe and the share of the cosine, which alone is best for a diffuse
  /// surface without shadows: of a few, those of the least variance under even light, over random places and views.
  SrbfBtfDraws(const SrbfEvaluator& evaluator, uint32_t side);

  /// Fills the density of `mixture` for a finished point; its value is 0. No allocation.
  void fill(const SrbfEvaluator& evaluator, const SrbfPoint& point, WarpedMixture& mixture) const;
  /// The same lobes over light directions.
  static void propose(const WarpedMixture& mixture, ProposalLobes& lobes);

  float half_bandwidth() const { return half_bandwidth_; }

 private:
  float half_bandwidth_ = 0, cosine_share_ = 1;
};

}  // namespace velour

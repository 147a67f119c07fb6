// The densities of a parametric model: how f cos of its lobes differs from f, tabulated over the view.
#pragma once

#include <cstdint>
#include <vector>

#include "material/parametric_values.h"
#include "material/view_nodes.h"
#include "srbf/lobe_products.h"

namespace velour {

/// Each lobe's Gaussian for draws is kept relative to the lobe itself (its centre's offset, the ratio of bandwidths),
/// so that few nodes serve: the sharpest highlight is followed by the model's own splines. Immutable; thread-safe.
class ParametricDraws {
 public:
  explicit ParametricDraws(const ParametricValues& values);

  /// Fills in the density of a mixture that `values` has evaluated at `place`. A twentieth of it, and the mass of lobes
  /// that are nearly constant, is the cosine's. No allocation. Run-time dispatched SIMD.
  void add_to(const ViewPlace& place, WarpedMixture& mixture) const;
  /// The lobes of f cos over light directions at the mixture's view, joined to few, in the surface's frame: those of
  /// the nearest node, turned with the mirror direction of the view.
  void propose(const WarpedMixture& mixture, ProposalLobes& lobes) const;

  /// A bit for each lobe that matters (idle_lobes.h) at any node from the one before `first` to the one behind `last`,
  /// on a meridian of an isotropic model. The others have probability 0 there.
  uint32_t matter_between(const ViewPlace& first, const ViewPlace& last) const;

  uint64_t bytes() const;

  /// Columns of a row, each of the padded number of lobes.
  enum Column { kOffsetX, kOffsetY, kOffsetZ, kBandwidthRatio, kBelow, kUpTo, kColumns };

 private:
  void fill_node(const ParametricValues& values, int node);

  bool isotropic_;
  int padded_;
  ViewNodes nodes_;
  std::vector<float> rows_;               // [node][column][padded lobe]
  std::vector<ProposalLobes> proposals_;  // of each node, in the lobes' frame
  std::vector<uint32_t> matter_;          // of each node
};

}  // namespace velour

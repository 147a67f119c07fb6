// A parametric model at evenly spread views: which of its lobes matter, and a few Gaussians that resemble f cos.
#pragma once

#include <cstdint>
#include <vector>

#include "material/parametric_values.h"
#include "material/view_nodes.h"
#include "srbf/lobe_products.h"
#include "srbf/warped_lobe.h"

namespace velour {

/// The lobes of a mixture's value, as scalar code has them, in its frame.
std::vector<WarpedLobe> lobes_of(const WarpedMixture& mixture);

/// Immutable; thread-safe; no allocation after construction.
class ParametricNodes {
 public:
  explicit ParametricNodes(const ParametricValues& values);

  /// Light-space Gaussians that resemble f cos at `wv`, in the surface's frame: the moments of each lobe's part of it
  /// at the nearest node, joined to few, turned with the mirror direction of the view.
  void propose(const Vec3& wv, ProposalLobes& lobes) const;

  /// A bit for each lobe that matters (idle_lobes.h) at any node from the one before `first` to the one behind `last`,
  /// on a meridian of an isotropic model.
  uint32_t matter_between(const ViewPlace& first, const ViewPlace& last) const;

 private:
  void fill_node(const ParametricValues& values, int node);

  bool isotropic_;
  ViewNodes nodes_;
  std::vector<ProposalLobes> proposals_;  // of each node, in the lobes' frame
  std::vector<uint32_t> matter_;          // of each node
};

}  // namespace velour

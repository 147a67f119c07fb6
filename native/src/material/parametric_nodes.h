// A parametric model at evenly spread views: which of its lobes matter, and a few Gaussians that resemble f cos.
#pragma once

#include <cstdint>
#include <vector>

#include "material/parametric_values.h"
#include "material/view_nodes.h"
#include "srbf/lobe_products.h"
#include "srbf/warped_lobe.h"

namespace velour {

/// The lobes of a mixture's value as WarpedLobes, in the mixture's frame.
std::vector<WarpedLobe> lobes_of(const WarpedMixture& mixture);

/// Immutable; thread-safe; no allocation after construction.
class ParametricNodes {
 public:
  explicit ParametricNodes(const ParametricValues& values);

  /// Gaussians over light directions that approximate f cos at `wv`, in the surface's frame. They match the moments of
  /// each lobe's part at the nearest node, are merged to a few, and rotate with the view's mirror direction.
  void propose(const Vec3& wv, ProposalLobes& lobes) const;

  /// Bit mask of the lobes that matter (idle_lobes.h) at any node from the one before `first` to the one after `last`,
  /// on a meridian of an isotropic model.
  uint32_t matter_between(const ViewPlace& first, const ViewPlace& last) const;

 private:
  void fill_node(const ParametricValues& values, int node);

  bool isotropic_;
  ViewNodes nodes_;
  std::vector<ProposalLobes> proposals_;  // per node, in the lobes' frame
  std::vector<uint32_t> matter_;          // per node
};

}  // namespace velour

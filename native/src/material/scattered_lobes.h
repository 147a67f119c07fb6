// The lobes of a scattered model at any view: neighbours found, turned into the view's frame, weighted.
#pragma once

#include <vector>

#include "brdf/scattered_brdf.h"
#include "material/view_lobes.h"
#include "material/view_neighbors.h"
#include "srbf/lobe_mixture.h"
#include "srbf/lobe_products.h"

namespace velour {

/// Immutable; thread-safe; no allocation after construction.
class ScatteredLobes {
 public:
  /// `neighbors` views are mixed, 0: the model's default. Throws Error(invalid_argument) when there are more than
  /// kMaxNeighbors or when their lobes exceed LobeMixture::kCapacity.
  ScatteredLobes(const ScatteredBrdf& brdf, int neighbors);

  bool isotropic() const { return isotropic_; }

  /// The stored views that stand for one asked for, and how their slices turn to it.
  struct Placement {
    ViewNeighbors views;
    Mat3 rotation[kMaxNeighbors];
  };
  Placement place(const Vec3& wv) const;
  /// The same of the dissertation's K nearest views [T09 7.3]: `neighbors`, or four as far as their lobes fit a
  /// mixture.
  Placement place_nearest(const Vec3& wv) const;

  /// The mixture of f cos, with a cosine share that keeps its density positive wherever f may be.
  void gather(const Placement& placed, LobeMixture& mixture) const;
  /// The nearest view's f cos in as many lobes as a proposal holds.
  void propose(const Placement& placed, ProposalLobes& lobes) const;

 private:
  Placement turned(const ViewNeighbors& views, const Vec3& wv) const;
  void add_view(const ScatteredBrdf& brdf, size_t view);

  bool isotropic_, align_views_;
  int neighbors_;
  std::vector<Vec3> views_;
  ViewSearch search_, nearest_;  // of the model's neighbours, and of the dissertation's
  std::vector<float> theta_;     // of the views, radians
  ViewLobes lobes_;
  std::vector<ProposalLobes> proposals_;  // of each view
};

}  // namespace velour

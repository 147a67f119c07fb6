// The lobes of a scattered model at any view: neighbours found, turned into the view's frame, weighted.
#pragma once

#include <vector>

#include "brdf/scattered_brdf.h"
#include "material/view_neighbors.h"
#include "srbf/lobe_mixture.h"
#include "srbf/lobe_products.h"

namespace velour {

/// Immutable; thread-safe; gather() allocates nothing.
class ScatteredLobes {
 public:
  /// `neighbors` views are mixed, 0: the model's default. Throws Error(invalid_argument) when there are more than
  /// kMaxNeighbors or when their lobes exceed LobeMixture::kCapacity.
  ScatteredLobes(const ScatteredBrdf& brdf, int neighbors);

  bool isotropic() const { return isotropic_; }
  /// The mixture of f cos at `wv`, with a cosine share that keeps its density positive wherever f may be.
  void gather(const Vec3& wv, LobeMixture& mixture) const;
  /// The nearest view's lobes of f cos at `wv`, joined to few: for proposals.
  void propose(const Vec3& wv, ProposalLobes& lobes) const;

 private:
  /// The stored views that stand for one asked for, and how their slices turn to it.
  struct Placement {
    ViewNeighbors views;
    Mat3 rotation[kMaxNeighbors];
  };
  Placement place(const Vec3& wv) const;
  Placement place_on_meridian(const Vec3& wv) const;
  Placement place_on_hemisphere(const Vec3& wv) const;
  void add_slice(int view, const Mat3& rotation, float weight, LobeMixture& mixture) const;

  Kernel kernel_;
  bool isotropic_, align_views_;
  int neighbors_;
  std::vector<Vec3> views_;
  ViewSearch search_;
  std::vector<Rgb> diffuse_;
  std::vector<float> theta_;  // of the views, radians
  std::vector<uint32_t> first_lobe_;
  std::vector<float> x_, y_, z_, bandwidth_, r_, g_, b_, luminance_, mass_;
  std::vector<ProposalLobes> proposals_;  // of each view
};

}  // namespace velour

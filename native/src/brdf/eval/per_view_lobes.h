// The lobes of a per-view model at any view: neighboring views are found, rotated into the view's frame and weighted.
#pragma once

#include <cstdint>
#include <span>
#include <vector>
#include "brdf/model/per_view_brdf.h"
#include "math/sphere/vec.h"
#include "math/srbf/lobe_mixture.h"
#include "math/srbf/lobe_products.h"

namespace velour {

// The sampled views that are mixed for a view direction, and their weights (method 6.4).

inline constexpr int kMaxNeighbors = 8;

/// Indices into a set of views; the weights are positive and sum to 1. Empty only for an empty set.
struct ViewNeighbors {
  int count = 0;
  int index[kMaxNeighbors];
  float weight[kMaxNeighbors];
};

/// Linear weights of the two polar angles of sorted `theta` (radians) around `theta_v`; beyond an end, that end alone.
ViewNeighbors bracketing_views(std::span<const float> theta, float theta_v);

/// Search for the nearest of a set of views. Candidates are tabulated by direction, so that a search tests a dozen
/// views instead of all. Immutable; thread-safe.
class ViewSearch {
 public:
  /// Searches for the `k` <= kMaxNeighbors nearest of `views`.
  ViewSearch(std::span<const Vec3> views, int k);

  /// The k nearest views of unit `wv` with weight 1/angle_i - 1/angle_(k+1), so that a view's weight has fallen to 0
  /// when another takes its place. A hit gives that view alone.
  ViewNeighbors nearest(const Vec3& wv) const;

 private:
  void fill_cell(int cell);
  static constexpr int kSide = 32;  // octahedral cells per side; even, so that no fold of the map crosses a cell

  std::vector<Vec3> views_;
  int k_;
  std::vector<uint32_t> candidates_, first_;  // candidates of cell c: [first_[c], first_[c + 1]), increasing
};

// The lobes of many views, in the layout that LobeMixture appends.

/// Built view by view: add() the lobes, then end_view(). Structure of arrays.
class ViewLobes {
 public:
  explicit ViewLobes(Kernel kernel) : kernel_(kernel) {}

  void add(const Vec3& center, float bandwidth, const Rgb& coefficient);
  /// `diffuse`: coefficient of the clipped cosine.
  void end_view(const Rgb& diffuse);

  /// Appends a view's lobes, rotated and times `weight`, to `mixture`. The diffuse part is tied to the normal and does
  /// not rotate with the highlight.
  void append_to(LobeMixture& mixture, size_t view, const Mat3& rotation, float weight) const;
  Kernel kernel() const { return kernel_; }

 private:
  Kernel kernel_;
  std::vector<float> x_, y_, z_, bandwidth_, r_, g_, b_, luminance_, mass_;
  std::vector<size_t> first_{0};
  std::vector<Rgb> diffuse_;
};

/// Immutable; thread-safe; no allocation after construction.
class PerViewLobes {
 public:
  /// Mixes `neighbors` views; 0: the model's default. Throws Error(invalid_argument) when there are more than
  /// kMaxNeighbors or when their lobes exceed LobeMixture::kCapacity.
  PerViewLobes(const PerViewBrdf& brdf, int neighbors);

  bool isotropic() const { return isotropic_; }

  /// The stored views to mix for a query, and the rotations of their slices.
  struct Placement {
    ViewNeighbors views;
    Mat3 rotation[kMaxNeighbors];
  };
  Placement place(const Vec3& wv) const;
  /// Placement by the K nearest views, as in the dissertation [T09 7.3]: K is `neighbors` or, if that is 0, four or as
  /// many as fit in a mixture with their lobes.
  Placement place_nearest(const Vec3& wv) const;

  /// The mixture of f cos, with a cosine share that keeps its density positive wherever f may be.
  void gather(const Placement& placed, LobeMixture& mixture) const;
  /// The nearest view's f cos, merged to as many lobes as a proposal holds.
  void propose(const Placement& placed, ProposalLobes& lobes) const;

 private:
  Placement turned(const ViewNeighbors& views, const Vec3& wv) const;
  void add_view(const PerViewBrdf& brdf, size_t view);

  bool isotropic_, align_views_;
  int neighbors_;
  std::vector<Vec3> views_;
  ViewSearch search_, nearest_;  // for the model's neighbors and for the dissertation's
  std::vector<float> theta_;     // polar angles of the views, radians
  ViewLobes lobes_;
  std::vector<ProposalLobes> proposals_;  // per view
};

}  // namespace velour

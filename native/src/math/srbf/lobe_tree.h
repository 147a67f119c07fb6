// A hierarchy over many Gaussian lobes, so that a few nodes can represent all of them: fine where it matters, coarse
// elsewhere.
#pragma once

#include <cstdint>
#include <vector>

#include "math/srbf/lobe_products.h"

namespace velour {

/// Leaves are the lobes; an inner node is the Gaussian that has the integral and the mean direction of all lobes under
/// it (the maximum-likelihood von Mises-Fisher density [BDGS05]). Built bottom-up by joining the two nodes whose energy
/// spreads least. Immutable; thread-safe.
class LobeTree {
 public:
  /// Skips lobes of amplitude 0. Quadratic in the number of lobes.
  explicit LobeTree(const GaussianLobes& lobes);

  bool empty() const { return nodes_.empty(); }
  /// Returns at most `most` (> 0) nodes that together contain every lobe exactly once. Starting at the root, opens the
  /// node whose product with `lobe` is approximated worst by one Gaussian; a lobe of bandwidth 0 judges the nodes
  /// themselves. Nodes are in tree order, which keeps neighbors together, so stratified random numbers stay stratified.
  std::vector<GaussianLobe> cut(const GaussianLobe& lobe, int most) const;

 private:
  struct Node {
    Vec3d sum;      // energy x mean direction
    double energy;  // integral over the sphere
    GaussianLobe lobe;
    int child[2];  // -1: a leaf
  };
  Node joined(int first, int second) const;
  void join_all();
  double misfit(const Node& node, const GaussianLobe& lobe) const;
  std::vector<GaussianLobe> in_order(const std::vector<uint8_t>& opened) const;

  std::vector<Node> nodes_;  // the root last
};

}  // namespace velour

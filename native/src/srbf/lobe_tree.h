// A hierarchy over many Gaussian lobes, so that few nodes stand for all of them: fine where it matters, coarse
// elsewhere.
#pragma once

#include <cstdint>
#include <vector>

#include "srbf/lobe_products.h"

namespace velour {

/// Leaves are the lobes; an inner node is the Gaussian that has the integral and the mean direction of all lobes under
/// it (the von Mises-Fisher density of the greatest likelihood [BDGS05]). Built from below: the two nodes are joined
/// whose energy spreads least by it. Immutable; thread-safe.
class LobeTree {
 public:
  /// Lobes of amplitude 0 are left out. Quadratic in the number of lobes.
  explicit LobeTree(const GaussianLobes& lobes);

  bool empty() const { return nodes_.empty(); }
  /// At most `most` (> 0) nodes under which every lobe lies exactly once. From the root on, that node is opened whose
  /// product with `lobe` is told worst by one Gaussian; a lobe of bandwidth 0 asks about the nodes themselves. The
  /// nodes come in the order of the tree: neighbours are near each other, so that evenly spread random numbers stay so.
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

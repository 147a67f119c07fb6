// Where tables over view directions have their nodes, and how a view is placed between them.
#pragma once

#include "material/view_place.h"

namespace velour {

/// The nodes about a view, linear weights of sum 1, and the node nearest to it.
struct NodeWeights {
  int count;
  int node[4];
  float weight[4];
  int nearest;
};

/// Nodes on the disk of Lambert's equal-area map, (x, y) / sqrt(1 + z): it needs one root, has no pole, and is even in
/// solid angle. Isotropic: `cells` intervals along the radius at azimuth 0; otherwise `cells` over each side of the
/// square about the disk.
class ViewNodes {
 public:
  ViewNodes(bool isotropic, int cells) : isotropic_(isotropic), cells_(cells) {}

  int count() const { return isotropic_ ? cells_ + 1 : (cells_ + 1) * (cells_ + 1); }
  /// The view of a node, unit. Nodes outside the disk have that of the horizon's nearest point.
  Vec3 view(int node) const;
  NodeWeights at(const ViewPlace& place) const;

 private:
  bool isotropic_;
  int cells_;
};

}  // namespace velour

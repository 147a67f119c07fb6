// Nodes of tables over view directions, and the interpolation between them.
#pragma once

#include "material/view_place.h"

namespace velour {

/// The nodes around a view, linear weights that sum to 1, and the node nearest to the view.
struct NodeWeights {
  int count;
  int node[4];
  float weight[4];
  int nearest;
};

/// Nodes on the disk of Lambert's equal-area map, (x, y) / sqrt(1 + z), which needs one root, has no pole and is
/// uniform in solid angle. Isotropic: `cells` intervals along the radius at azimuth 0; otherwise `cells` along each
/// side of the square around the disk.
class ViewNodes {
 public:
  ViewNodes(bool isotropic, int cells) : isotropic_(isotropic), cells_(cells) {}

  int count() const { return isotropic_ ? cells_ + 1 : (cells_ + 1) * (cells_ + 1); }
  /// The unit view of a node. Nodes outside the disk have the nearest view on the horizon.
  Vec3 view(int node) const;
  NodeWeights at(const ViewPlace& place) const;

 private:
  bool isotropic_;
  int cells_;
};

}  // namespace velour

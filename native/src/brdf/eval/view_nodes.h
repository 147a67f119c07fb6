// Nodes of tables over view directions, and the interpolation between them.
#pragma once

#include <algorithm>
#include <cmath>
#include "math/sphere/vec.h"

namespace velour {

// A view direction in the coordinates of tables and splines over views, computed once per view.

/// arccos z = sqrt(1 - z) times a polynomial (Abramowitz & Stegun 4.4.46), for z >= 0; `radius` is the root. Terms are
/// evaluated in pairs, which halves the latency.
inline float polar_angle(float radius, float z) {
  const float z2 = z * z, z4 = z2 * z2;
  const float a = 1.5707963050f - 0.2145988016f * z, b = 0.0889789874f - 0.0501743046f * z;
  const float c = 0.0308918810f - 0.0170881256f * z, d = 0.0066700901f - 0.0012624911f * z;
  return radius * ((a + b * z2) + (c + d * z2) * z4);
}

/// Float precision suffices: a spline of the view changes by a fraction of itself over a tenth of a radian.
struct ViewPlace {
  float sine;              // of the polar angle
  float cos_phi, sin_phi;  // 1, 0 at the normal
  float radius;            // of Lambert's equal-area map, sqrt(1 - cos theta), without cancellation
  float theta;             // radians, absolute error below 3e-7

  /// Requires unit `wv` on or above the horizon.
  explicit ViewPlace(const Vec3& wv) {
    const float z = std::max(wv.z, 0.0f), sine_sq = wv.x * wv.x + wv.y * wv.y;
    sine = std::sqrt(sine_sq);
    const float inverse = 1 / std::max(sine, 1e-30f);
    cos_phi = sine > 0 ? inverse * wv.x : 1.0f;
    sin_phi = inverse * wv.y;
    radius = std::sqrt(sine_sq / (1 + z));
    theta = polar_angle(radius, z);
  }
};

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

// Choice among many lights by their expected contribution at a point.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/progress.h"
#include "math/sphere/affine.h"
#include "scene/motion.h"

namespace velour {

inline constexpr double kDoubleBelowOne = 0x1.fffffffffffffp-1;

/// A point that gathers light.
struct LightPlace {
  Vec3 position{0.0f};
  Vec3 normal{0.0f};        // unit: light counts by its cosine; zero: light from all sides counts equally
  bool both_sides = false;  // light from below counts as well
  float time = kMiddleTime;
};

/// Directions of emission: full intensity within `cos_normals` of the axis, beyond that reduced by the cosine of the
/// excess angle, and none from `cos_end` on.
struct LightCone {
  Vec3 axis{0.0f, 0.0f, 1.0f};
  float cos_normals = -1.0f;  // -1: uniform in all directions
  float cos_end = 0.0f;
};

/// A binary tree over lights [EK18]. Of two children, one is chosen in proportion to its importance at the point: its
/// intensity over the squared distance from the center of its box (or over the squared radius of the box if that is
/// larger), times the maximum cosines that emission and reception can have there. Every light has a probability above 0
/// at every point. Immutable; thread-safe; no allocation.
class LightTree {
 public:
  struct Light {
    Bounds box;
    float intensity;  // luminance, W/sr or proportional to it; above 0, finite
    LightCone cone{};
  };
  LightTree() = default;
  /// Throws Error(cancelled).
  LightTree(std::span<const Light> lights, const Progress& progress);

  bool empty() const { return intensity_.empty(); }
  size_t size() const { return node_of_.size(); }
  /// Total intensity of all lights.
  float intensity() const { return empty() ? 0.0f : intensity_[0]; }
  float intensity(uint32_t light) const { return intensity_[node_of_[light]]; }
  const Bounds& bounds() const { return bounds_; }

  /// Index of a light chosen by `x`, uniform in [0, 1). `x` returns its residual: uniform again, and increasing within
  /// the light's share. The tree must not be empty.
  uint32_t choose(const LightPlace& place, double& x) const;
  /// Probability that choose() returns `light`.
  double probability(const LightPlace& place, uint32_t light) const;

  /// Importances at a point of up to kCut nodes that cover all lights. Their sum is closer to the irradiance there than
  /// the root's importance, and a choice from them follows it better than one from the root. A few lights are all
  /// distinguished.
  static constexpr size_t kCut = 16;
  struct Cut {
    std::array<double, kCut> sum{};  // prefix sums of the importances
    double total() const { return sum[kCut - 1]; }
  };
  Cut cut(const LightPlace& place) const;
  uint32_t choose(const Cut& cut, const LightPlace& place, double& x) const;
  double probability(const Cut& cut, const LightPlace& place, uint32_t light) const;

  /// Calls visit(light) for every light whose box a ray from `origin` may hit.
  template <class Visit>
  void meet(const Vec3& origin, const Vec3& direction, Visit&& visit) const;

 private:
  static constexpr uint32_t kLeaf = 0x80000000u;
  static constexpr uint32_t kNoCut = 0xffffffffu;
  struct Node {
    Vec3 middle;
    float radius_sq;
    LightCone cone;
    float sin_normals;
    uint32_t link;  // index of the right child, or kLeaf and the light; the left child is the next node
    uint32_t parent;
    Vec3 half;        // half the sides of the box
    uint32_t in_cut;  // index in the cut, or kNoCut
  };
  void build(std::span<const Light> lights, std::span<uint32_t> order, uint32_t parent, const Progress& progress);
  void set_cone(uint32_t node, const LightCone& cone);
  void choose_cut();
  float importance(uint32_t node, const LightPlace& place) const;
  /// Probability of the left one of two siblings.
  double share(uint32_t left, uint32_t right, const LightPlace& place) const;
  uint32_t descend(uint32_t node, const LightPlace& place, double& x) const;
  /// Probability that descend() from `top` reaches `node`.
  double probability_below(uint32_t top, uint32_t node, const LightPlace& place) const;
  bool may_meet(const Node& node, const Vec3& origin, const Vec3& inverse) const;

  std::vector<Node> nodes_;
  std::vector<float> intensity_;   // by node
  std::vector<uint32_t> node_of_;  // by light
  std::vector<uint32_t> cut_;      // nodes
  Bounds bounds_;
};

template <class Visit>
void LightTree::meet(const Vec3& origin, const Vec3& direction, Visit&& visit) const {
  if (empty()) return;
  const Vec3 inverse = 1.0f / direction;
  uint32_t waiting[64], count = 0;  // suffices: every level halves the lights
  waiting[count++] = 0;
  while (count > 0) {
    const uint32_t at = waiting[--count];
    const Node& node = nodes_[at];
    if (!may_meet(node, origin, inverse)) continue;
    if ((node.link & kLeaf) != 0) {
      visit(node.link & ~kLeaf);
    } else {
      waiting[count++] = node.link;
      waiting[count++] = at + 1;
    }
  }
}

}  // namespace velour

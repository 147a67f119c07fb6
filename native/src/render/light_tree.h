// Choice among many lights, by what they are likely to bring to a place.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "job/progress.h"
#include "scene/bounds.h"

namespace velour {

inline constexpr double kDoubleBelowOne = 0x1.fffffffffffffp-1;

/// Where light is gathered.
struct LightPlace {
  Vec3 position{0.0f};
  Vec3 normal{0.0f};        // unit: light counts by its cosine; zero: light from every side counts alike
  bool both_sides = false;  // light from below counts as well
};

/// Directions of emission: within `cos_normals` of the axis all intensity, from there on less by the cosine of the
/// angle beyond, and none from `cos_end` on.
struct LightCone {
  Vec3 axis{0.0f, 0.0f, 1.0f};
  float cos_normals = -1.0f;  // -1: alike to all sides
  float cos_end = 0.0f;
};

/// A binary tree over lights [EK18]: of two children one is chosen in proportion to its importance at the place: its
/// intensity over the squared distance from the middle of its box (or over the box' squared radius where that is
/// larger), times the largest cosines that emission and reception can have there. Wherever the place, every light has a
/// probability above 0. Immutable; thread-safe; no allocation.
class LightTree {
 public:
  struct Light {
    Bounds box;
    float intensity;  // luminance, W/sr or in proportion to it; above 0, finite
    LightCone cone{};
  };
  LightTree() = default;
  /// Throws Error(cancelled).
  LightTree(std::span<const Light> lights, const Progress& progress);

  bool empty() const { return intensity_.empty(); }
  size_t size() const { return node_of_.size(); }
  /// Of all lights.
  float intensity() const { return empty() ? 0.0f : intensity_[0]; }
  float intensity(uint32_t light) const { return intensity_[node_of_[light]]; }
  const Bounds& bounds() const { return bounds_; }

  /// The number of a light, chosen by `x`, uniform in [0, 1), which comes back as what is left of it: uniform again,
  /// and growing within the light's share. Only of a tree that is not empty.
  uint32_t choose(const LightPlace& place, double& x) const;
  /// That choose() gives `light`.
  double probability(const LightPlace& place, uint32_t light) const;

  /// Importances at one place of up to kCut nodes that hold all lights: their sum is nearer to the irradiance there
  /// than the root's importance, and the choice from them nearer to it than one from the root. Few lights are all told
  /// apart.
  static constexpr size_t kCut = 16;
  struct Cut {
    std::array<double, kCut> sum{};  // of the importances up to and with each
    double total() const { return sum[kCut - 1]; }
  };
  Cut cut(const LightPlace& place) const;
  uint32_t choose(const Cut& cut, const LightPlace& place, double& x) const;
  double probability(const Cut& cut, const LightPlace& place, uint32_t light) const;

  /// Calls visit(light) for every light whose box a ray from `origin` may meet.
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
    uint32_t link;  // the right child, or kLeaf and the light; the left child is the next node
    uint32_t parent;
    Vec3 half;        // of the box' sides
    uint32_t in_cut;  // its number in the cut, or kNoCut
  };
  void build(std::span<const Light> lights, std::span<uint32_t> order, uint32_t parent, const Progress& progress);
  void set_cone(uint32_t node, const LightCone& cone);
  void choose_cut();
  float importance(uint32_t node, const LightPlace& place) const;
  /// Of the left one of two siblings.
  double share(uint32_t left, uint32_t right, const LightPlace& place) const;
  uint32_t descend(uint32_t node, const LightPlace& place, double& x) const;
  /// That descend() from `top` comes to `node`.
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
  uint32_t waiting[64], count = 0;  // half of the lights at every level
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

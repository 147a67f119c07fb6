// Choice among many small lights, by power and nearness.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "job/progress.h"
#include "scene/camera.h"

namespace velour {

/// A binary tree over the lights, as of [EK18]: from the root down one of two children is chosen in proportion to its
/// importance, power over the squared distance from the middle of its box, or over the box' squared radius where that
/// is larger. Whatever the position, every light has a probability above 0. Immutable; thread-safe; no allocation.
class LightTree {
 public:
  struct Light {
    Bounds box;
    float power;  // above 0, finite
  };
  LightTree() = default;
  /// Throws Error(cancelled).
  LightTree(std::span<const Light> lights, const Progress& progress);

  bool empty() const { return power_.empty(); }
  size_t size() const { return node_of_.size(); }
  /// Of all lights.
  float power() const { return empty() ? 0.0f : power_[0]; }
  float power(uint32_t light) const { return power_[node_of_[light]]; }
  const Bounds& bounds() const { return bounds_; }

  /// The number of a light, chosen by `x`, uniform in [0, 1), which comes back as what is left of it: uniform again,
  /// and growing within the light's share. Only of a tree that is not empty.
  uint32_t choose(const Vec3& position, double& x) const;
  /// That choose() gives `light`.
  double probability(const Vec3& position, uint32_t light) const;

 private:
  static constexpr uint32_t kLeaf = 0x80000000u;
  void build(std::span<const Light> lights, std::span<uint32_t> order, uint32_t parent, const Progress& progress);
  double importance(uint32_t node, const Vec3& position) const;
  /// Of the left one of two siblings.
  double share(uint32_t left, uint32_t right, const Vec3& position) const;

  // By node; the left child of a node is the next one.
  std::vector<Vec3> middle_;
  std::vector<float> radius_sq_, power_;
  std::vector<uint32_t> link_;  // the right child, or kLeaf and the light
  std::vector<uint32_t> parent_;
  std::vector<uint32_t> node_of_;  // by light
  Bounds bounds_;
};

}  // namespace velour

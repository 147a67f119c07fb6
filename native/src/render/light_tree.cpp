#include "render/light_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace velour {
namespace {

constexpr double kDoubleBelowOne = 0x1.fffffffffffffp-1;
constexpr uint32_t kNoParent = 0xffffffffu;

int widest_axis(const Bounds& bounds) {
  const Vec3 size = bounds.high - bounds.low;
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

}  // namespace

LightTree::LightTree(std::span<const Light> lights, const Progress& progress) : node_of_(lights.size()) {
  if (lights.empty()) return;
  const size_t nodes = 2 * lights.size() - 1;
  middle_.reserve(nodes);
  radius_sq_.reserve(nodes);
  power_.reserve(nodes);
  link_.reserve(nodes);
  parent_.reserve(nodes);
  for (const Light& light : lights) bounds_.add(light.box);
  std::vector<uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  build(lights, order, kNoParent, progress);
}

void LightTree::build(std::span<const Light> lights, std::span<uint32_t> order, uint32_t parent,
                      const Progress& progress) {
  progress.check();
  const auto node = static_cast<uint32_t>(power_.size());
  Bounds box, middles;
  double power = 0;
  for (const uint32_t i : order) {
    box.add(lights[i].box);
    middles.add(lights[i].box.center());
    power += static_cast<double>(lights[i].power);
  }
  middle_.push_back(box.center());
  radius_sq_.push_back(std::max(box.radius() * box.radius(), 1e-30f));
  power_.push_back(static_cast<float>(power));
  parent_.push_back(parent);
  link_.push_back(kLeaf | order[0]);
  if (order.size() == 1) {
    node_of_[order[0]] = node;
    return;
  }
  const int axis = widest_axis(middles);
  const size_t half = order.size() / 2;
  std::ranges::nth_element(order, order.begin() + static_cast<std::ptrdiff_t>(half), {},
                           [&](uint32_t i) { return std::pair(lights[i].box.center()[axis], i); });
  build(lights, order.first(half), node, progress);
  link_[node] = static_cast<uint32_t>(power_.size());
  build(lights, order.subspan(half), node, progress);
}

double LightTree::importance(uint32_t node, const Vec3& position) const {
  const Vec3 d = position - middle_[node];
  return static_cast<double>(power_[node]) / static_cast<double>(std::max(glm::dot(d, d), radius_sq_[node]));
}

double LightTree::share(uint32_t left, uint32_t right, const Vec3& position) const {
  const double one = importance(left, position), other = importance(right, position), sum = one + other;
  return sum > 0.0 && std::isfinite(sum) ? one / sum : 0.5;
}

uint32_t LightTree::choose(const Vec3& position, double& x) const {
  uint32_t node = 0;
  while ((link_[node] & kLeaf) == 0) {
    const uint32_t left = node + 1, right = link_[node];
    const double p = share(left, right, position);
    const bool first = x < p;
    x = std::min(first ? x / p : (x - p) / (1.0 - p), kDoubleBelowOne);
    node = first ? left : right;
  }
  return link_[node] & ~kLeaf;
}

double LightTree::probability(const Vec3& position, uint32_t light) const {
  double probability = 1;
  for (uint32_t node = node_of_[light]; node != 0; node = parent_[node]) {
    const uint32_t parent = parent_[node], left = parent + 1, right = link_[parent];
    const double p = share(left, right, position);
    probability *= node == left ? p : 1.0 - p;
  }
  return probability;
}

}  // namespace velour

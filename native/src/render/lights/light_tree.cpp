#include "render/lights/light_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace velour {
namespace {

constexpr uint32_t kNoParent = 0xffffffffu;
/// Minimum of the product of both cosine bounds: they are rounded, and no light may have a probability of 0.
constexpr float kMinCosines = 1e-3f;

int widest_axis(const Bounds& bounds) {
  const Vec3 size = bounds.high - bounds.low;
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

/// An angle in [0, pi], as its cosine and sine.
struct Angle {
  float cos, sin;
  explicit Angle(float cosine) : cos(cosine), sin(std::sqrt(std::max(0.0f, 1.0f - cosine * cosine))) {}
  Angle(float cosine, float sine) : cos(cosine), sin(sine) {}
  /// This angle minus the other, at least 0.
  Angle less(const Angle& other) const {
    if (cos >= other.cos) return {1.0f, 0.0f};
    return {cos * other.cos + sin * other.sin, sin * other.cos - cos * other.sin};
  }
};

/// A cone that contains both.
LightCone join(const LightCone& a, const LightCone& b) {
  LightCone joined{a.axis, -1.0f, std::min(a.cos_end, b.cos_end)};
  if (a.cos_normals <= -1.0f || b.cos_normals <= -1.0f) return joined;
  const LightCone &wide = a.cos_normals <= b.cos_normals ? a : b, &narrow = a.cos_normals <= b.cos_normals ? b : a;
  const float wide_half = std::acos(wide.cos_normals), narrow_half = std::acos(narrow.cos_normals);
  const float between = std::acos(std::clamp(glm::dot(wide.axis, narrow.axis), -1.0f, 1.0f));
  if (between + narrow_half <= wide_half) {
    joined.axis = wide.axis;
    joined.cos_normals = wide.cos_normals;
    return joined;
  }
  const float half = 0.5f * (wide_half + between + narrow_half);
  const Vec3 across = narrow.axis - glm::dot(narrow.axis, wide.axis) * wide.axis;
  const float length = glm::length(across);
  if (half >= kPi || !(length > 1e-6f)) return joined;
  const float turn = half - wide_half;
  joined.axis = glm::normalize(std::cos(turn) * wide.axis + std::sin(turn) / length * across);
  joined.cos_normals = std::cos(half);
  return joined;
}

}  // namespace

LightTree::LightTree(std::span<const Light> lights, const Progress& progress) : node_of_(lights.size()) {
  if (lights.empty()) return;
  nodes_.reserve(2 * lights.size() - 1);
  intensity_.reserve(nodes_.capacity());
  for (const Light& light : lights) bounds_.add(light.box);
  std::vector<uint32_t> order(lights.size());
  std::iota(order.begin(), order.end(), 0u);
  build(lights, order, kNoParent, progress);
  choose_cut();
}

void LightTree::build(std::span<const Light> lights, std::span<uint32_t> order, uint32_t parent,
                      const Progress& progress) {
  progress.check();
  const auto at = static_cast<uint32_t>(nodes_.size());
  Bounds box, middles;
  double intensity = 0;
  for (const uint32_t i : order) {
    box.add(lights[i].box);
    middles.add(lights[i].box.center());
    intensity += static_cast<double>(lights[i].intensity);
  }
  intensity_.push_back(static_cast<float>(intensity));
  Node& node = nodes_.emplace_back();
  node.middle = box.center();
  node.half = 0.5f * (box.high - box.low);
  node.radius_sq = std::max(box.radius() * box.radius(), 1e-30f);
  node.parent = parent;
  node.link = kLeaf | order[0];
  node.in_cut = kNoCut;
  if (order.size() == 1) {
    node_of_[order[0]] = at;
    set_cone(at, lights[order[0]].cone);
    return;
  }
  const int axis = widest_axis(middles);
  const size_t half = order.size() / 2;
  std::ranges::nth_element(order, order.begin() + static_cast<std::ptrdiff_t>(half), {},
                           [&](uint32_t i) { return std::pair(lights[i].box.center()[axis], i); });
  build(lights, order.first(half), at, progress);
  const auto right = static_cast<uint32_t>(nodes_.size());
  nodes_[at].link = right;
  build(lights, order.subspan(half), at, progress);
  set_cone(at, join(nodes_[at + 1].cone, nodes_[right].cone));
}

void LightTree::set_cone(uint32_t node, const LightCone& cone) {
  nodes_[node].cone = cone;
  nodes_[node].sin_normals = Angle(cone.cos_normals).sin;
}

/// Splits the node whose importance varies most over space first: the one with the largest product of intensity and
/// extent.
void LightTree::choose_cut() {
  const auto spread = [&](uint32_t n) {
    return (nodes_[n].link & kLeaf) != 0 ? -1.0f : intensity_[n] * std::sqrt(nodes_[n].radius_sq);
  };
  cut_ = {0};
  while (cut_.size() < kCut) {
    const auto widest = std::ranges::max_element(cut_, {}, spread);
    const uint32_t node = *widest;
    if ((nodes_[node].link & kLeaf) != 0) break;
    *widest = node + 1;
    cut_.push_back(nodes_[node].link);
  }
  for (uint32_t i = 0; i < cut_.size(); ++i) nodes_[cut_[i]].in_cut = i;
}

float LightTree::importance(uint32_t number, const LightPlace& place) const {
  const Node& node = nodes_[number];
  const Vec3 to_node = node.middle - place.position;
  const float distance_sq = glm::dot(to_node, to_node);
  const float plain = intensity_[number] / std::max(distance_sq, node.radius_sq);
  if (!(distance_sq > node.radius_sq)) return plain;  // light may come from any side
  const Vec3 w = to_node / std::sqrt(distance_sq);
  const float sine_sq = node.radius_sq / distance_sq;
  const Angle extent(std::sqrt(1.0f - sine_sq), std::sqrt(sine_sq));
  float cosines = 1.0f;
  if (node.cone.cos_normals > -1.0f) {
    const Angle normals(node.cone.cos_normals, node.sin_normals);
    const Angle beyond = Angle(-glm::dot(w, node.cone.axis)).less(normals).less(extent);
    cosines = beyond.cos > node.cone.cos_end ? std::max(beyond.cos, 0.0f) : 0.0f;
  }
  if (place.normal != Vec3(0.0f)) {
    const float cosine = glm::dot(w, place.normal);
    cosines *= std::max(Angle(place.both_sides ? std::abs(cosine) : cosine).less(extent).cos, 0.0f);
  }
  return plain * std::max(cosines, kMinCosines);
}

double LightTree::share(uint32_t left, uint32_t right, const LightPlace& place) const {
  const auto one = static_cast<double>(importance(left, place)), other = static_cast<double>(importance(right, place));
  const double sum = one + other;
  return sum > 0.0 && std::isfinite(sum) ? one / sum : 0.5;
}

uint32_t LightTree::descend(uint32_t node, const LightPlace& place, double& x) const {
  while ((nodes_[node].link & kLeaf) == 0) {
    const uint32_t left = node + 1, right = nodes_[node].link;
    const double p = share(left, right, place);
    const bool first = x < p;
    x = std::min(first ? x / p : (x - p) / (1.0 - p), kDoubleBelowOne);
    node = first ? left : right;
  }
  return nodes_[node].link & ~kLeaf;
}

uint32_t LightTree::choose(const LightPlace& place, double& x) const { return descend(0, place, x); }

double LightTree::probability(const LightPlace& place, uint32_t light) const {
  return probability_below(0, node_of_[light], place);
}

double LightTree::probability_below(uint32_t top, uint32_t node, const LightPlace& place) const {
  double probability = 1;
  for (; node != top; node = nodes_[node].parent) {
    const uint32_t parent = nodes_[node].parent, left = parent + 1;
    const double p = share(left, nodes_[parent].link, place);
    probability *= node == left ? p : 1.0 - p;
  }
  return probability;
}

LightTree::Cut LightTree::cut(const LightPlace& place) const {
  Cut cut;
  double sum = 0;
  for (size_t i = 0; i < kCut; ++i) {
    // Above 0 and finite, even at the light itself or beyond the range of a float.
    if (i < cut_.size()) sum += static_cast<double>(std::clamp(importance(cut_[i], place), 1e-37f, 1e37f));
    cut.sum[i] = sum;
  }
  return cut;
}

uint32_t LightTree::choose(const Cut& cut, const LightPlace& place, double& x) const {
  const double at = x * cut.total();
  size_t chosen = 0;
  while (chosen + 1 < cut_.size() && at >= cut.sum[chosen]) ++chosen;
  const double low = chosen == 0 ? 0.0 : cut.sum[chosen - 1];
  x = std::clamp((at - low) / (cut.sum[chosen] - low), 0.0, kDoubleBelowOne);
  return descend(cut_[chosen], place, x);
}

double LightTree::probability(const Cut& cut, const LightPlace& place, uint32_t light) const {
  uint32_t top = node_of_[light];
  while (nodes_[top].in_cut == kNoCut) top = nodes_[top].parent;
  const size_t i = nodes_[top].in_cut;
  const double low = i == 0 ? 0.0 : cut.sum[i - 1];
  return (cut.sum[i] - low) / cut.total() * probability_below(top, node_of_[light], place);
}

/// Slab test, widened by the rounding errors of directions and distances.
bool LightTree::may_meet(const Node& node, const Vec3& origin, const Vec3& inverse) const {
  constexpr float kRounding = 1e-6f;
  const Vec3 middle = node.middle - origin;
  const float slack = kRounding * (std::abs(middle.x) + std::abs(middle.y) + std::abs(middle.z));
  const Vec3 half = node.half + slack;
  float near = 0.0f, far = std::numeric_limits<float>::infinity();
  for (int i = 0; i < 3; ++i) {
    const float a = (middle[i] - half[i]) * inverse[i], b = (middle[i] + half[i]) * inverse[i];
    near = std::max(near, std::min(a, b));  // a NaN (0 times infinity, along a side) does not bound
    far = std::min(far, std::max(a, b));
  }
  return near <= far;
}

}  // namespace velour

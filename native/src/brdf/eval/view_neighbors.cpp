#include "brdf/eval/view_neighbors.h"

#include <algorithm>

#include "math/sphere/directions.h"
#include "math/sphere/warp.h"

namespace velour {

namespace {

/// Angle between unit directions, from the chord, which keeps small angles that a dot product would lose.
float angle_between(const Vec3& a, const Vec3& b) { return 2 * std::asin(std::min(0.5f * glm::distance(a, b), 1.0f)); }

/// The floor is below the rounding of a float direction and represents an exact hit.
float inverse_angle(const Vec3& a, const Vec3& b) {
  constexpr float kHit = 1e-8f;
  return 1 / std::max(angle_between(a, b), kHit);
}

/// Drops negligible weights, which makes a hit exact and saves its neighbors' lobes, and scales the sum to 1.
void normalize(ViewNeighbors& set) {
  constexpr float kNegligible = 1e-5f;
  float total = 0;
  for (int i = 0; i < set.count; ++i) total += set.weight[i];
  if (total <= 0) {  // all candidates are equally far
    std::fill_n(set.weight, set.count, 1.0f);
    total = static_cast<float>(set.count);
  }
  int kept = 0;
  float kept_total = 0;
  for (int i = 0; i < set.count; ++i) {
    if (set.weight[i] <= kNegligible * total) continue;
    set.index[kept] = set.index[i];
    kept_total += set.weight[kept] = set.weight[i];
    ++kept;
  }
  for (int i = 0; i < kept; ++i) set.weight[i] /= kept_total;
  set.count = kept;
}

}  // namespace

ViewNeighbors bracketing_views(std::span<const float> theta, float theta_v) {
  ViewNeighbors set;
  if (theta.empty()) return set;
  const int last = static_cast<int>(theta.size()) - 1;
  const auto above = static_cast<int>(std::upper_bound(theta.begin(), theta.end(), theta_v) - theta.begin());
  if (above == 0 || above > last) {
    set.count = 1;
    set.index[0] = std::min(above, last);
    set.weight[0] = 1;
    return set;
  }
  const float low = theta[static_cast<size_t>(above - 1)], high = theta[static_cast<size_t>(above)];
  const float share = (theta_v - low) / (high - low);  // high > theta_v >= low
  set.count = 2;
  set.index[0] = above - 1;
  set.index[1] = above;
  set.weight[0] = 1 - share;
  set.weight[1] = share;
  normalize(set);
  return set;
}

ViewSearch::ViewSearch(std::span<const Vec3> views, int k) : views_(views.begin(), views.end()), k_(k), first_{0} {
  for (int cell = 0; cell < kSide * kSide; ++cell) fill_cell(cell);
}

/// Let r be the cell's radius about its center c, and v the last of the k + 1 views nearest to c. From any direction in
/// the cell, k + 1 views are within angle(c, v) + r, so the k + 1 nearest are as well, and these are within angle(c, v)
/// + 2 r of c. A cell is a convex polygon, or two that share its corners, so its farthest points are corners.
void ViewSearch::fill_cell(int cell) {
  constexpr float kRounding = 1e-3f;
  const Vec3 center = octahedral_cell_center(cell, kSide);
  const Vec2 low(static_cast<float>(cell % kSide), static_cast<float>(cell / kSide));
  float radius = 0;
  for (const Vec2& corner : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
    radius = std::max(radius, angle_between(octahedral_to((low + corner) / static_cast<float>(kSide)), center));
  }
  int found[kMaxNeighbors + 1];
  const int count = nearest_directions(views_, center, k_ + 1, found);
  const float last = count > 0 ? angle_between(views_[static_cast<size_t>(found[count - 1])], center) : 0;
  for (uint32_t i = 0; i < views_.size(); ++i) {
    if (angle_between(views_[i], center) <= last + 2 * radius + kRounding) candidates_.push_back(i);
  }
  first_.push_back(static_cast<uint32_t>(candidates_.size()));
}

ViewNeighbors ViewSearch::nearest(const Vec3& wv) const {
  const auto cell = static_cast<size_t>(octahedral_cell(wv, kSide));
  const auto among = std::span(candidates_).subspan(first_[cell], first_[cell + 1] - first_[cell]);
  int found[kMaxNeighbors + 1];
  const int count = nearest_directions(views_, among, wv, k_ + 1, found);
  const auto inverse = [&](int i) { return inverse_angle(views_[static_cast<size_t>(found[i])], wv); };
  const float cutoff = count > k_ ? inverse(k_) : 0;
  ViewNeighbors set;
  set.count = std::min(count, k_);
  for (int i = 0; i < set.count; ++i) {
    set.index[i] = found[i];
    set.weight[i] = std::max(inverse(i) - cutoff, 0.0f);
  }
  if (set.count > 0) normalize(set);
  return set;
}

}  // namespace velour

#include "material/view_neighbors.h"

#include <algorithm>

#include "sphere/directions.h"

namespace velour {

namespace {

/// 1 / angle between unit directions. The floor is below the rounding of a float direction and stands for a hit; the
/// chord keeps small angles that a dot product would lose.
float inverse_angle(const Vec3& a, const Vec3& b) {
  constexpr float kHit = 1e-8f;
  return 1 / std::max(2 * std::asin(std::min(0.5f * glm::distance(a, b), 1.0f)), kHit);
}

/// Drops what cannot be seen, which makes a hit exact and saves its neighbours' lobes, and scales the sum to 1.
void normalize(ViewNeighbors& set) {
  constexpr float kNegligible = 1e-5f;
  float total = 0;
  for (int i = 0; i < set.count; ++i) total += set.weight[i];
  if (total <= 0) {  // every candidate equally far: nothing tells them apart
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

ViewNeighbors nearest_views(std::span<const Vec3> views, const Vec3& wv, int k) {
  int found[kMaxNeighbors + 1];
  const int count = nearest_directions(views, wv, k + 1, found);
  const float cutoff = count > k ? inverse_angle(views[static_cast<size_t>(found[k])], wv) : 0;
  ViewNeighbors set;
  set.count = std::min(count, k);
  for (int i = 0; i < set.count; ++i) {
    set.index[i] = found[i];
    set.weight[i] = std::max(inverse_angle(views[static_cast<size_t>(found[i])], wv) - cutoff, 0.0f);
  }
  if (set.count > 0) normalize(set);
  return set;
}

}  // namespace velour

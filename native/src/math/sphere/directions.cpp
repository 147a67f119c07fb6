#include "math/sphere/directions.h"

#include <algorithm>

namespace velour {

namespace {

std::vector<Vec3> fibonacci(int n, double z_bottom) {
  const double golden_angle = kPiD * (3.0 - std::sqrt(5.0));
  std::vector<Vec3> set(static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) {
    const double z = 1.0 - (1.0 - z_bottom) * (i + 0.5) / n;
    const double r = std::sqrt((1.0 - z) * (1.0 + z));
    const double phi = golden_angle * i;
    set[static_cast<size_t>(i)] = Vec3(r * std::cos(phi), r * std::sin(phi), z);
  }
  return set;
}

}  // namespace

std::vector<Vec3> hemisphere_fibonacci(int n) { return fibonacci(n, 0.0); }

std::vector<Vec3> sphere_fibonacci(int n) { return fibonacci(n, -1.0); }

namespace {

/// The nearest of set[place(0)], set[place(1)], ...
template <typename Place>
int nearest(std::span<const Vec3> set, int count, const Vec3& d, int k, int* indices, Place&& place) {
  constexpr int kMax = 16;
  k = std::min({k, kMax, count});
  float best[kMax];
  int found = 0;
  for (int i = 0; i < count; ++i) {
    const int candidate = place(i);
    const float t = glm::dot(set[static_cast<size_t>(candidate)], d);
    if (found == k && t <= best[k - 1]) continue;
    int at = found < k ? found++ : k - 1;
    for (; at > 0 && best[at - 1] < t; --at) {
      best[at] = best[at - 1];
      indices[at] = indices[at - 1];
    }
    best[at] = t;
    indices[at] = candidate;
  }
  return k;
}

}  // namespace

int nearest_directions(std::span<const Vec3> set, const Vec3& d, int k, int* indices) {
  return nearest(set, static_cast<int>(set.size()), d, k, indices, [](int i) { return i; });
}

int nearest_directions(std::span<const Vec3> set, std::span<const uint32_t> among, const Vec3& d, int k, int* indices) {
  return nearest(set, static_cast<int>(among.size()), d, k, indices,
                 [&](int i) { return static_cast<int>(among[static_cast<size_t>(i)]); });
}

}  // namespace velour

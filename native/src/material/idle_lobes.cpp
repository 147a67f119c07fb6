#include "material/idle_lobes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace velour {

namespace {

/// Error from dropping a lobe, relative to the limits of idle_lobes.h.
struct Loss {
  double albedo = 0, norm = 0, value = 0;

  double most() const { return std::max({albedo, norm, value}); }
  void add(const Loss& other) {
    albedo += other.albedo;
    norm += other.norm;
    value += other.value;
  }
};

double largest_channel(const WarpedMixture& m, int j) {
  return static_cast<double>(std::max({m.r[j], m.g[j], m.b[j]}));
}

Loss loss_of(const WarpedMixture& lobes, int j, const LightPoints& points) {
  const double channel = largest_channel(lobes, j);
  double mass = 0, albedo = 0, norm_sq = 0, lost_sq = 0, most = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    if (!(points.weight(i) > 0)) continue;
    const double part = channel * points.kernel(i, j) * points.per_value(i);
    const double f_cos = points.weight(i) * points.value(i) * static_cast<double>(points.light(i).z);
    mass += points.weight(i);
    albedo += part * points.weight(i);
    norm_sq += f_cos;
    lost_sq += part * part * f_cos;
    most = std::max(most, part);
  }
  if (!(mass > 0)) return {1e30, 1e30, 1e30};
  return {albedo / mass / kIdleAlbedo, std::sqrt(lost_sq / norm_sq) / kIdleNorm, most / kIdleValue};
}

}  // namespace

uint32_t lobes_that_matter(const WarpedMixture& lobes, const LightPoints& points) {
  std::vector<Loss> loss;
  for (int j = 0; j < lobes.count; ++j) loss.push_back(loss_of(lobes, j, points));
  std::vector<size_t> order(loss.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return loss[a].most() < loss[b].most(); });
  uint32_t matter = 0;
  Loss lost;
  for (const size_t j : order) {
    lost.add(loss[j]);
    if (!(lost.most() <= 1)) matter |= uint32_t{1} << j;
  }
  return matter;
}

}  // namespace velour

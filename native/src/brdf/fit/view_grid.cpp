#include "brdf/fit/view_grid.h"

#include <algorithm>
#include <cmath>
#include "brdf/measure/held_out.h"
#include "math/sphere/directions.h"

namespace velour {

namespace {

constexpr double kMeridianStep = 2.0, kMeridianEnd = 89.0;  // degrees
constexpr int kHemisphereViews = 400;                       // a spacing of about 7 degrees
// Slightly more than the margin, so that rounding does not bring a view inside.
constexpr double kSafeMargin = kHeldOutMargin + 0.05;

/// `theta` (degrees), moved to the nearer edge of the margin if a held-out view is too close.
double outside_margins(double theta) {
  for (const int held_out : kHeldOutViews) {
    const double away = theta - held_out;
    if (std::abs(away) < kSafeMargin) return held_out + (away < 0 ? -kSafeMargin : kSafeMargin);
  }
  return theta;
}

/// theta_h where ring i of a light grid begins.
double ring_edge(int i, int rings) { return 0.5 * kPiD * i * i / (rings * rings); }

/// Solid angle of half vectors of one cell of ring i.
double half_vector_cell(int i, int rings, int spokes) {
  const double begin = ring_edge(i, rings), end = ring_edge(i + 1, rings);
  return 2 * std::sin(0.5 * (begin + end)) * std::sin(0.5 * (end - begin)) * 2 * kPiD / spokes;
}

}  // namespace

std::vector<Vec3> meridian_views(bool all_data) {
  std::vector<double> theta{0};
  const auto go_to = [&theta](double end) {
    const double begin = theta.back();
    const int steps = std::max(1, static_cast<int>(std::ceil((end - begin) / kMeridianStep)));
    for (int k = 1; k <= steps; ++k) theta.push_back(begin + (end - begin) * k / steps);
  };
  for (const int held_out : kHeldOutViews) {
    go_to(all_data ? held_out : held_out - kSafeMargin);
    if (!all_data) theta.push_back(held_out + kSafeMargin);  // one step over the gap
  }
  go_to(kMeridianEnd);
  std::vector<Vec3> views;
  for (const double t : theta) views.push_back(direction(static_cast<float>(radians_from(t)), 0.0f));
  return views;
}

std::vector<Vec3> hemisphere_views(bool all_data) {
  std::vector<Vec3> views = hemisphere_fibonacci(kHemisphereViews);
  if (all_data) return views;
  for (Vec3& v : views) {
    const double theta = std::acos(std::clamp(static_cast<double>(v.z), -1.0, 1.0)) * 180 / kPiD;
    v = direction(static_cast<float>(radians_from(outside_margins(theta))), std::atan2(v.y, v.x));
  }
  return views;
}

LightGrid light_grid(const Vec3& wv, int rings, int spokes) {
  LightGrid grid;
  const double azimuth = std::atan2(static_cast<double>(wv.y), static_cast<double>(wv.x));
  for (int i = 0; i < rings; ++i) {
    const double cell = half_vector_cell(i, rings, spokes),
                 theta = 0.5 * (ring_edge(i, rings) + ring_edge(i + 1, rings));
    const double turn = i * kGoldenRatio;  // neighboring rings do not line up
    for (int k = 0; k < spokes; ++k) {
      const double phi = azimuth + 2 * kPiD * (k + turn - std::floor(turn)) / spokes;
      const Vec3d h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double cosine = glm::dot(Vec3d(wv), h);
      if (cosine <= 0) continue;
      const Vec3 wl(glm::normalize(2 * cosine * h - Vec3d(wv)));
      if (wl.z <= 0) continue;
      grid.wl.push_back(wl);
      grid.weight.push_back(static_cast<float>(4 * cosine * cell));
      grid.ring.push_back(static_cast<uint32_t>(i));
    }
  }
  return grid;
}

void redistribute_weights(LightGrid& grid, std::span<const uint8_t> kept) {
  const size_t rings = grid.ring.empty() ? 0 : grid.ring.back() + size_t{1};  // rings are in ascending order
  std::vector<double> all(rings, 0.0), left(rings, 0.0);
  for (size_t i = 0; i < grid.wl.size(); ++i) {
    all[grid.ring[i]] += grid.weight[i];
    if (kept[i]) left[grid.ring[i]] += grid.weight[i];
  }
  for (size_t i = 0; i < grid.wl.size(); ++i) {
    const uint32_t r = grid.ring[i];
    if (left[r] > 0) grid.weight[i] = static_cast<float>(grid.weight[i] * all[r] / left[r]);
  }
}

}  // namespace velour

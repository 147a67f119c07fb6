#include "fit/close_rings.h"

#include <algorithm>
#include <cmath>

namespace velour {

void CloseRings::append(std::vector<Vec3>& out) const {
  for (int i = 0; i < rings_; ++i) {
    const double angle = i == 0 ? inner_ / std::sqrt(2.0) : std::sqrt(edge(i) * edge(i + 1));
    const double turn = 0.6180339887498949 * i;  // golden ratio: neighboring rings do not line up
    for (int k = 0; k < spokes_; ++k) {
      const double phi = 2 * kPiD * (k + turn) / spokes_;
      const Vec3d local(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi), std::cos(angle));
      out.push_back(glm::normalize(frame_.to_world(Vec3(local))));
    }
  }
}

double CloseRings::density(const Vec3& w) const {
  const double angle = 2 * std::asin(std::min(1.0, 0.5 * glm::length(Vec3d(w) - Vec3d(axis_))));
  if (angle >= edge(rings_)) return 0;
  const double ring = angle < inner_ ? 0 : 1 + std::log(angle / inner_) / log_step();
  const int i = std::min(static_cast<int>(ring), rings_ - 1);
  const double begin = i == 0 ? 0 : edge(i), end = edge(i + 1);
  // cos(begin) - cos(end) without cancellation.
  return spokes_ / (4 * kPiD * std::sin(0.5 * (begin + end)) * std::sin(0.5 * (end - begin)));
}

double CloseRings::log_step() const { return std::log(outer_ / inner_) / (rings_ - 1); }

double CloseRings::edge(int i) const { return inner_ * std::exp((i - 1) * log_step()); }

}  // namespace velour

#include "plot/polyline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace velour {
namespace {

float distance_to_segment(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 d = b - a;
  const float along = std::clamp(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-12f), 0.0f, 1.0f);
  return glm::length(p - a - along * d);
}

}  // namespace

std::vector<Vec2> simplified(const std::vector<Vec2>& points, float tolerance) {
  if (points.size() < 3) return points;
  std::vector<uint8_t> kept(points.size());
  kept.front() = kept.back() = 1;
  std::vector<std::pair<size_t, size_t>> open{{0, points.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    float most = tolerance;
    size_t furthest = first;
    for (size_t i = first + 1; i < last; ++i) {
      const float away = distance_to_segment(points[i], points[first], points[last]);
      if (away > most) most = away, furthest = i;
    }
    if (furthest == first) continue;
    kept[furthest] = 1;
    open.emplace_back(first, furthest);
    open.emplace_back(furthest, last);
  }
  std::vector<Vec2> out;
  for (size_t i = 0; i < points.size(); ++i) {
    if (kept[i]) out.push_back(points[i]);
  }
  return out;
}

std::vector<std::vector<Vec2>> dashed(const std::vector<Vec2>& points, float on, float off) {
  std::vector<std::vector<Vec2>> pieces;
  if (points.empty()) return pieces;
  bool drawing = true;
  float left = on;
  pieces.push_back({points.front()});
  for (size_t i = 1; i < points.size(); ++i) {
    Vec2 at = points[i - 1];
    float rest = glm::length(points[i] - at);
    while (rest > left) {
      at += (points[i] - at) * (left / rest);
      rest -= left;
      drawing ? pieces.back().push_back(at) : pieces.push_back({at});
      drawing = !drawing;
      left = drawing ? on : off;
    }
    left -= rest;
    if (drawing) pieces.back().push_back(points[i]);
  }
  return pieces;
}

}  // namespace velour

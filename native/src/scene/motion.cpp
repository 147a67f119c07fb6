#include "scene/motion.h"

#include <cmath>
#include <functional>
#include <glm/gtc/quaternion.hpp>

namespace velour {
namespace {

/// Rotation, symmetric stretch and translation of a transform: x -> turn * stretch * x + shift.
struct Decomposed {
  glm::dquat turn;
  glm::dmat3 stretch;
  Vec3d shift;
};

/// Polar decomposition by Newton's iteration [SD92]. A mirrored stretch keeps the rotation proper.
Decomposed decomposed(const Affine& map) {
  const glm::dmat3 linear(Vec3d(map.column(0)), Vec3d(map.column(1)), Vec3d(map.column(2)));
  glm::dmat3 turn = linear;
  constexpr int kMaxIterations = 100;
  constexpr double kConverged = 1e-24;  // square of the change of an entry
  for (int i = 0; i < kMaxIterations; ++i) {
    const glm::dmat3 next = 0.5 * (turn + glm::transpose(glm::inverse(turn)));
    const glm::dmat3 change = next - turn;
    turn = next;
    if (glm::dot(change[0], change[0]) + glm::dot(change[1], change[1]) + glm::dot(change[2], change[2]) < kConverged)
      break;
  }
  if (glm::determinant(turn) < 0) turn *= -1.0;
  return {glm::quat_cast(turn), glm::transpose(turn) * linear, Vec3d(map.column(3))};
}

Affine between(const Decomposed& one, const Decomposed& other, double t) {
  const glm::dmat3 stretch = one.stretch * (1 - t) + other.stretch * t;
  const glm::dmat3 linear = glm::mat3_cast(glm::slerp(one.turn, other.turn, t)) * stretch;
  const Vec3d shift = (1 - t) * one.shift + t * other.shift;
  Affine map;
  for (int row = 0; row < 3; ++row) {
    for (int c = 0; c < 3; ++c) map.m[4 * row + c] = static_cast<float>(linear[c][row]);
    map.m[4 * row + 3] = static_cast<float>(shift[row]);
  }
  return map;
}

double angle_between(const Decomposed& one, const Decomposed& other) {
  return 2 * std::acos(std::min(1.0, std::abs(glm::dot(one.turn, other.turn))));
}

}  // namespace

std::vector<Affine> motion_steps(std::span<const Affine> keys) {
  if (std::ranges::adjacent_find(keys, std::not_equal_to<>()) == keys.end()) return {};
  std::vector<Affine> steps(keys.begin(), keys.end());
  if (!std::ranges::all_of(keys, &Affine::invertible)) return steps;  // a flat one has no rotation
  std::vector<Decomposed> parts;
  double turn = 0;
  for (const Affine& key : keys) {
    parts.push_back(decomposed(key));
    if (parts.size() > 1) turn = std::max(turn, angle_between(parts[parts.size() - 2], parts.back()));
  }
  const size_t most = (kMaxMotionSteps - 1) / (keys.size() - 1);
  const size_t pieces =
      std::clamp<size_t>(static_cast<size_t>(std::ceil(turn / kMaxTurn)), 1, std::max<size_t>(1, most));
  if (pieces == 1) return steps;
  steps.clear();
  for (size_t i = 0; i + 1 < keys.size(); ++i) {
    steps.push_back(keys[i]);
    for (size_t k = 1; k < pieces; ++k) {
      steps.push_back(between(parts[i], parts[i + 1], static_cast<double>(k) / static_cast<double>(pieces)));
    }
  }
  steps.push_back(keys.back());
  return steps;
}

}  // namespace velour

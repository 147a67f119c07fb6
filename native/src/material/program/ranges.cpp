// Blender's Clamp, Map Range and Mapping nodes (kernel/svm/clamp.h, map_range.h, mapping_util.h of Cycles).
#include <algorithm>
#include <cmath>
#include "material/program/numbers.h"
#include "material/program/operands.h"

namespace velour {
namespace {

float within(float value, float a, float b) { return std::min(std::max(value, std::min(a, b)), std::max(a, b)); }

float in_steps(float share, float steps) { return steps > 0 ? std::floor(share * (steps + 1)) / steps : 0.0f; }

/// Share of the way from `from` to `to`, by the curve.
float share_of(RangeCurve curve, float value, float from, float to, float steps) {
  const float share = ratio(value - from, to - from);
  switch (curve) {
    case RangeCurve::linear:
      return share;
    case RangeCurve::stepped:
      return in_steps(share, steps);
    case RangeCurve::smoothstep:
      return smoothed(share);
    case RangeCurve::smootherstep:
      return smoother(share);
  }
  return share;
}

bool can_clamp(RangeCurve curve) { return curve == RangeCurve::linear || curve == RangeCurve::stepped; }

void run_clamp(const Operands& o) {
  const bool is_range = o.at.choice[0] != 0;
  o.each([&](int i) {
    const float value = o.number(0, i), low = o.number(1, i), high = o.number(2, i);
    o.out()[i] = is_range ? within(value, low, high) : std::min(std::max(value, low), high);
  });
}

void run_map_range(const Operands& o) {
  const auto curve = o.choice<RangeCurve>(0);
  const bool clamps = o.at.choice[1] != 0 && can_clamp(curve);
  o.each([&](int i) {
    const float from = o.number(1, i), to = o.number(2, i), low = o.number(3, i), high = o.number(4, i);
    float value = 0;
    if (from != to) value = low + share_of(curve, o.number(0, i), from, to, o.number(5, i)) * (high - low);
    o.out()[i] = clamps ? within(value, low, high) : value;
  });
}

void run_map_range_vector(const Operands& o) {
  const auto curve = o.choice<RangeCurve>(0);
  const bool clamps = o.at.choice[1] != 0 && can_clamp(curve);
  for (int c = 0; c < 3; ++c) {
    const auto at = [&](int operand, int i) { return o.in(operand, c)[i]; };
    o.each([&](int i) {
      const float low = at(3, i), high = at(4, i);
      const float value = low + share_of(curve, at(0, i), at(1, i), at(2, i), at(5, i)) * (high - low);
      o.out(c)[i] = clamps ? within(value, low, high) : value;
    });
  }
}

/// Rotation about x, then y, then z, by angles in radians.
Mat3 rotation_of(const Vec3& angles) {
  const Vec3 c = glm::cos(angles), s = glm::sin(angles);
  return {Vec3(c.y * c.z, c.y * s.z, -s.y), Vec3(s.x * s.y * c.z - c.x * s.z, s.x * s.y * s.z + c.x * c.z, s.x * c.y),
          Vec3(c.x * s.y * c.z + s.x * s.z, c.x * s.y * s.z - s.x * c.z, c.x * c.y)};
}

Vec3 over(const Vec3& a, const Vec3& b) { return {ratio(a.x, b.x), ratio(a.y, b.y), ratio(a.z, b.z)}; }

Vec3 mapped(MappingKind kind, const Vec3& vector, const Vec3& location, const Mat3& rotation, const Vec3& scale) {
  switch (kind) {
    case MappingKind::point:
      return rotation * (vector * scale) + location;
    case MappingKind::texture:
      return over((vector - location) * rotation, scale);
    case MappingKind::vector:
      return rotation * (vector * scale);
    case MappingKind::normal:
      return unit_or_zero(rotation * over(vector, scale));
  }
  return vector;
}

}  // namespace

void run_ranges(const Operands& operands) {
  if (operands.at.operation == Operation::clamp) return run_clamp(operands);
  if (operands.at.operation == Operation::map_range) return run_map_range(operands);
  run_map_range_vector(operands);
}

void run_mapping(const Operands& operands) {
  if (operands.at.operation == Operation::mapping) {
    const auto kind = operands.choice<MappingKind>(0);
    Vec3 angles(0.0f);
    Mat3 rotation(1.0f);
    return operands.each([&](int i) {
      const Vec3 asked = operands.vector(2, i);  // constant in most programs
      if (asked != angles) rotation = rotation_of(angles = asked);
      operands.set(0, i, mapped(kind, operands.vector(0, i), operands.vector(1, i), rotation, operands.vector(3, i)));
    });
  }
  const float* m = operands.table;
  operands.each([&](int i) {
    const Vec3 p = operands.vector(0, i);
    for (int row = 0; row < 3; ++row) {
      operands.out(row)[i] = m[4 * row] * p.x + m[4 * row + 1] * p.y + m[4 * row + 2] * p.z + m[4 * row + 3];
    }
  });
}

}  // namespace velour

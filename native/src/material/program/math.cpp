// Blender's Math and Vector Math nodes (kernel/svm/math_util.h of Cycles). What is undefined is 0.
#include <algorithm>
#include <cmath>
#include <limits>

#include "material/program/operands.h"

namespace velour {

namespace {

float smooth_min(float a, float b, float width) {
  if (width == 0) return std::min(a, b);
  const float h = std::max(width - std::abs(a - b), 0.0f) / width;
  return std::min(a, b) - h * h * h * width * (1.0f / 6.0f);
}

float power(float a, float b) {
  if (a < 0 && b != std::trunc(b)) return 0;
  if (b == 0) return 1;
  return a == 0 ? 0.0f : std::pow(a, b);
}

float logarithm(float a, float base) { return a > 0 && base > 0 ? ratio(std::log(a), std::log(base)) : 0.0f; }

float pingpong(float a, float scale) {
  if (scale == 0) return 0;
  return std::abs(fraction((a - scale) / (scale * 2)) * scale * 2 - scale);
}

float sign(float a) { return a == 0 ? 0.0f : a < 0 ? -1.0f : 1.0f; }

/// Value of the operation, whose branch is taken once per batch.
template <class F>
void each_value(const Operands& operands, const F& f) {
  const bool clamped = operands.at.choice[1] != 0;
  const float *a = operands.in(0), *b = operands.in(1), *c = operands.in(2);
  float* out = operands.out();
  operands.each([&](int i) { out[i] = f(a[i], b[i], c[i]); });
  if (clamped) operands.each([&](int i) { out[i] = saturated(out[i]); });
}

template <class F>
void each_vector(const Operands& operands, const F& f) {
  operands.each([&](int i) {
    operands.set(0, i, f(operands.vector(0, i), operands.vector(1, i), operands.vector(2, i)));
    operands.out(3)[i] = 0;
  });
}

template <class F>
void each_component(const Operands& operands, const F& f) {
  each_vector(operands, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    return Vec3(f(a.x, b.x, c.x), f(a.y, b.y, c.y), f(a.z, b.z, c.z));
  });
}

template <class F>
void each_number(const Operands& operands, const F& f) {
  operands.each([&](int i) {
    operands.set(0, i, Vec3(0.0f));
    operands.out(3)[i] = f(operands.vector(0, i), operands.vector(1, i));
  });
}

Vec3 refracted(const Vec3& incident, const Vec3& normal, float eta) {
  const float cosine = glm::dot(normal, incident), k = 1 - eta * eta * (1 - cosine * cosine);
  return k < 0 ? Vec3(0.0f) : eta * incident - (eta * cosine + std::sqrt(k)) * normal;
}

}  // namespace

void run_math(const Operands& operands) {
  const auto each = [&](const auto& f) { each_value(operands, f); };
  switch (operands.choice<MathOperation>(0)) {
    case MathOperation::add:
      return each([](float a, float b, float) { return a + b; });
    case MathOperation::subtract:
      return each([](float a, float b, float) { return a - b; });
    case MathOperation::multiply:
      return each([](float a, float b, float) { return a * b; });
    case MathOperation::divide:
      return each([](float a, float b, float) { return ratio(a, b); });
    case MathOperation::multiply_add:
      return each([](float a, float b, float c) { return a * b + c; });
    case MathOperation::power:
      return each([](float a, float b, float) { return power(a, b); });
    case MathOperation::logarithm:
      return each([](float a, float b, float) { return logarithm(a, b); });
    case MathOperation::sqrt:
      return each([](float a, float, float) { return std::sqrt(std::max(a, 0.0f)); });
    case MathOperation::inverse_sqrt:
      return each([](float a, float, float) { return a > 0 ? 1 / std::sqrt(a) : 0.0f; });
    case MathOperation::absolute:
      return each([](float a, float, float) { return std::abs(a); });
    case MathOperation::exponent:
      return each([](float a, float, float) { return std::exp(a); });
    case MathOperation::minimum:
      return each([](float a, float b, float) { return std::min(a, b); });
    case MathOperation::maximum:
      return each([](float a, float b, float) { return std::max(a, b); });
    case MathOperation::less_than:
      return each([](float a, float b, float) { return a < b ? 1.0f : 0.0f; });
    case MathOperation::greater_than:
      return each([](float a, float b, float) { return a > b ? 1.0f : 0.0f; });
    case MathOperation::sign:
      return each([](float a, float, float) { return sign(a); });
    case MathOperation::compare:
      return each([](float a, float b, float c) {
        return a == b || std::abs(a - b) <= std::max(c, std::numeric_limits<float>::epsilon()) ? 1.0f : 0.0f;
      });
    case MathOperation::smooth_min:
      return each([](float a, float b, float c) { return smooth_min(a, b, c); });
    case MathOperation::smooth_max:
      return each([](float a, float b, float c) { return -smooth_min(-a, -b, c); });
    case MathOperation::round:
      return each([](float a, float, float) { return std::floor(a + 0.5f); });
    case MathOperation::floor:
      return each([](float a, float, float) { return std::floor(a); });
    case MathOperation::ceil:
      return each([](float a, float, float) { return std::ceil(a); });
    case MathOperation::trunc:
      return each([](float a, float, float) { return std::trunc(a); });
    case MathOperation::fract:
      return each([](float a, float, float) { return fraction(a); });
    case MathOperation::modulo:
      return each([](float a, float b, float) { return b != 0 ? std::fmod(a, b) : 0.0f; });
    case MathOperation::floored_modulo:
      return each([](float a, float b, float) { return b != 0 ? a - std::floor(a / b) * b : 0.0f; });
    case MathOperation::wrap:
      return each([](float a, float b, float c) { return wrapped(a, b, c); });
    case MathOperation::snap:
      return each([](float a, float b, float) { return std::floor(ratio(a, b)) * b; });
    case MathOperation::pingpong:
      return each([](float a, float b, float) { return pingpong(a, b); });
    case MathOperation::sine:
      return each([](float a, float, float) { return std::sin(a); });
    case MathOperation::cosine:
      return each([](float a, float, float) { return std::cos(a); });
    case MathOperation::tangent:
      return each([](float a, float, float) { return std::tan(a); });
    case MathOperation::arcsine:
      return each([](float a, float, float) { return std::asin(std::clamp(a, -1.0f, 1.0f)); });
    case MathOperation::arccosine:
      return each([](float a, float, float) { return std::acos(std::clamp(a, -1.0f, 1.0f)); });
    case MathOperation::arctangent:
      return each([](float a, float, float) { return std::atan(a); });
    case MathOperation::arctan2:
      return each([](float a, float b, float) { return a == 0 && b == 0 ? 0.0f : std::atan2(a, b); });
    case MathOperation::sinh:
      return each([](float a, float, float) { return std::sinh(a); });
    case MathOperation::cosh:
      return each([](float a, float, float) { return std::cosh(a); });
    case MathOperation::tanh:
      return each([](float a, float, float) { return std::tanh(a); });
    case MathOperation::radians:
      return each([](float a, float, float) { return a * (kPi / 180); });
    case MathOperation::degrees:
      return each([](float a, float, float) { return a * (180 / kPi); });
  }
}

void run_vector_math(const Operands& operands) {
  const auto each = [&](const auto& f) { each_component(operands, f); };
  const auto vectors = [&](const auto& f) { each_vector(operands, f); };
  const auto numbers = [&](const auto& f) { each_number(operands, f); };
  switch (operands.choice<VectorOperation>(0)) {
    case VectorOperation::add:
      return each([](float a, float b, float) { return a + b; });
    case VectorOperation::subtract:
      return each([](float a, float b, float) { return a - b; });
    case VectorOperation::multiply:
      return each([](float a, float b, float) { return a * b; });
    case VectorOperation::divide:
      return each([](float a, float b, float) { return ratio(a, b); });
    case VectorOperation::multiply_add:
      return each([](float a, float b, float c) { return a * b + c; });
    case VectorOperation::cross_product:
      return vectors([](const Vec3& a, const Vec3& b, const Vec3&) { return glm::cross(a, b); });
    case VectorOperation::project:
      return vectors([](const Vec3& a, const Vec3& b, const Vec3&) {
        const float length_sq = glm::dot(b, b);
        return length_sq != 0 ? glm::dot(a, b) / length_sq * b : Vec3(0.0f);
      });
    case VectorOperation::reflect:
      return vectors([](const Vec3& a, const Vec3& b, const Vec3&) {
        const Vec3 normal = unit_or_zero(b);
        return a - 2 * glm::dot(normal, a) * normal;
      });
    case VectorOperation::refract:
      return operands.each([&](int i) {
        operands.set(0, i,
                     refracted(operands.vector(0, i), unit_or_zero(operands.vector(1, i)), operands.number(3, i)));
        operands.out(3)[i] = 0;
      });
    case VectorOperation::faceforward:
      return vectors([](const Vec3& a, const Vec3& b, const Vec3& c) { return glm::dot(c, b) < 0 ? a : -a; });
    case VectorOperation::dot_product:
      return numbers([](const Vec3& a, const Vec3& b) { return glm::dot(a, b); });
    case VectorOperation::distance:
      return numbers([](const Vec3& a, const Vec3& b) { return glm::length(a - b); });
    case VectorOperation::length:
      return numbers([](const Vec3& a, const Vec3&) { return glm::length(a); });
    case VectorOperation::scale:
      return operands.each([&](int i) {
        operands.set(0, i, operands.number(3, i) * operands.vector(0, i));
        operands.out(3)[i] = 0;
      });
    case VectorOperation::normalize:
      return vectors([](const Vec3& a, const Vec3&, const Vec3&) { return unit_or_zero(a); });
    case VectorOperation::absolute:
      return each([](float a, float, float) { return std::abs(a); });
    case VectorOperation::minimum:
      return each([](float a, float b, float) { return std::min(a, b); });
    case VectorOperation::maximum:
      return each([](float a, float b, float) { return std::max(a, b); });
    case VectorOperation::floor:
      return each([](float a, float, float) { return std::floor(a); });
    case VectorOperation::ceil:
      return each([](float a, float, float) { return std::ceil(a); });
    case VectorOperation::fraction:
      return each([](float a, float, float) { return fraction(a); });
    case VectorOperation::modulo:
      return each([](float a, float b, float) { return b != 0 ? std::fmod(a, b) : 0.0f; });
    case VectorOperation::wrap:
      return each([](float a, float b, float c) { return wrapped(a, b, c); });
    case VectorOperation::snap:
      return each([](float a, float b, float) { return std::floor(ratio(a, b)) * b; });
    case VectorOperation::sine:
      return each([](float a, float, float) { return std::sin(a); });
    case VectorOperation::cosine:
      return each([](float a, float, float) { return std::cos(a); });
    case VectorOperation::tangent:
      return each([](float a, float, float) { return std::tan(a); });
    case VectorOperation::power:
      return each([](float a, float b, float) { return power(a, b); });
    case VectorOperation::sign:
      return each([](float a, float, float) { return sign(a); });
    case VectorOperation::round:
      return each([](float a, float, float) { return std::floor(a + 0.5f); });
  }
}

// Blender's Clamp, Map Range and Mapping nodes (kernel/svm/clamp.h, map_range.h, mapping_util.h of Cycles).

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

void run_clamp(const Operands& o) {
  const bool is_range = o.at.choice[0] != 0;
  o.each([&](int i) {
    const float value = o.number(0, i), low = o.number(1, i), high = o.number(2, i);
    o.out()[i] = is_range ? within(value, low, high) : std::min(std::max(value, low), high);
  });
}

void run_map_range(const Operands& o) {
  const auto curve = o.choice<RangeCurve>(0);
  const bool clamps = o.at.choice[1] != 0;  // any curve: the value between equal limits may be outside
  o.each([&](int i) {
    const float from = o.number(1, i), to = o.number(2, i), low = o.number(3, i), high = o.number(4, i);
    float value = 0;
    if (from != to) value = low + share_of(curve, o.number(0, i), from, to, o.number(5, i)) * (high - low);
    o.out()[i] = clamps ? within(value, low, high) : value;
  });
}

void run_map_range_vector(const Operands& o) {
  const auto curve = o.choice<RangeCurve>(0);
  const bool clamps = o.at.choice[1] != 0 && (curve == RangeCurve::linear || curve == RangeCurve::stepped);
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

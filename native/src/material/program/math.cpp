// Blender's Math and Vector Math nodes (kernel/svm/math_util.h of Cycles). What is undefined is 0.
#include <algorithm>
#include <cmath>
#include <limits>
#include "material/program/numbers.h"
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

}  // namespace velour

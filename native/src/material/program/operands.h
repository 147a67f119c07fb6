// Operands of a program's operations, and safe arithmetic on them.
#pragma once

#include <algorithm>
#include <cmath>
#include "material/program/operations.h"
#include "material/program/program.h"
#include "math/sphere/vec.h"

namespace velour {

// Functions of numbers that several operations share; what is undefined is 0, as in Blender.

inline float ratio(float a, float b) { return b != 0 ? a / b : 0.0f; }
inline float fraction(float a) { return a - std::floor(a); }
inline float saturated(float a) { return std::min(std::max(a, 0.0f), 1.0f); }
inline float mixed(float a, float b, float share) { return a + share * (b - a); }

/// `a` moved by multiples of |max - min| into the interval between them.
inline float wrapped(float a, float max, float min) {
  const float range = max - min;
  return range != 0 ? a - range * std::floor((a - min) / range) : min;
}

/// 0 below 0, 1 above 1, 3 a^2 - 2 a^3 in between.
inline float smoothed(float a) {
  const float x = saturated(a);
  return x * x * (3 - 2 * x);
}
/// The same with a second derivative of 0 at both ends.
inline float smoother(float a) {
  const float x = saturated(a);
  return x * x * x * (x * (x * 6 - 15) + 10);
}

inline Vec3 unit_or_zero(const Vec3& v) {
  const float length = glm::length(v);
  return length > 0 ? v / length : Vec3(0.0f);
}

// An instruction's view of the registers, and the functions that carry out operations.

/// Each register holds ProgramMemory::kPoints floats. Kernels may compute and overwrite points beyond `count`.
struct Operands {
  static constexpr int kPoints = ProgramMemory::kPoints;

  const Instruction& at;
  float* registers;
  int count;
  const float* table;

  const float* in(int operand, int component = 0) const {
    return registers +
           (static_cast<size_t>(at.input[static_cast<size_t>(operand)]) + static_cast<size_t>(component)) * kPoints;
  }
  float* out(int component = 0) const {
    return registers + (static_cast<size_t>(at.output) + static_cast<size_t>(component)) * kPoints;
  }
  float number(int operand, int point) const { return in(operand)[point]; }
  Vec3 vector(int operand, int point) const {
    return {in(operand, 0)[point], in(operand, 1)[point], in(operand, 2)[point]};
  }
  void set(int component, int point, const Vec3& value) const {
    for (int i = 0; i < 3; ++i) out(component + i)[point] = value[i];
  }
  template <class Enum>
  Enum choice(size_t which) const {
    return static_cast<Enum>(at.choice[which]);
  }

  /// Applies `f(point)` to all points.
  template <class F>
  void each(const F& f) const {
    for (int point = 0; point < count; ++point) f(point);
  }
};

// By families. All are thread-safe and allocate nothing.
void run_math(const Operands& operands);
void run_vector_math(const Operands& operands);
void run_ranges(const Operands& operands);    // clamp, map_range
void run_mapping(const Operands& operands);   // mapping, transform
void run_color(const Operands& operands);     // mix_color to bright_contrast
void run_patterns(const Operands& operands);  // gradient, checker, brick, magic
void run_view(const Operands& operands);      // fresnel, layer_weight, normal_map, bump
void run_noise(const Operands& operands);     // noise, wave; SIMD, dispatched at run time
void run_voronoi(const Operands& operands);   // SIMD, dispatched at run time
void run_white_noise(const Operands& operands);

}  // namespace velour

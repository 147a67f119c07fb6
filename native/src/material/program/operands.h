// An instruction's view of the registers, and the functions that carry out operations.
#pragma once

#include "material/program/operations.h"
#include "material/program/program.h"
#include "math/sphere/vec.h"

namespace velour {

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

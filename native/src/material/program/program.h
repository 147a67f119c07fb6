// Values of a material's parameters computed at each point: Blender's texture and color nodes, as a flat program.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>
#include "base/memory.h"
#include "material/program/operations.h"
#include "material/surface_site.h"
#include "material/texture.h"
#include "math/sphere/vec.h"

namespace velour {

/// An image that a program looks up: a color or a number.
struct ProgramImage {
  std::shared_ptr<const Texture<Rgb>> color{};
  std::shared_ptr<const Texture<float>> number{};
};

/// A value that a program returns: three registers, or one if `is_number`.
struct ProgramOutput {
  uint32_t first = 0;
  bool is_number = false;
  bool is_normal = false;  // a unit direction in world space
  bool computed = true;    // false: left out by Program::only()
};

struct ProgramDescription {
  uint32_t registers = 0;
  std::vector<float> constants;  // values of the first registers
  std::vector<Instruction> instructions;
  std::vector<float> tables;
  std::vector<ProgramImage> images;
  std::vector<ProgramOutput> outputs;
  float step = 1;  // distance of shifted points, as a share of a pixel's width
};

/// A property of the surface that a program reads, and the registers that it is written to.
struct ProgramSource {
  Source kind;
  uint32_t set;
  Shift shift;
  uint32_t first;  // of three registers; numbers use the first
};

class ProgramMemory;

/// Immutable and thread-safe. Each register is written once, by a constant or an instruction, before it is read.
class Program {
 public:
  static constexpr uint32_t kMaxRegisters = 16384, kMaxInstructions = 4096, kMaxTableValues = 1 << 22,
                            kMaxImages = 1024;
  static constexpr size_t kMaxOutputs = SurfaceSite::kMaxComputed;

  /// Throws Error(invalid_argument) that names the instruction and the operand at fault.
  explicit Program(ProgramDescription description);

  /// The part of it that `outputs` (bits) depend on; other outputs keep their numbers and have no value.
  std::shared_ptr<const Program> only(uint32_t outputs) const;

  std::span<const ProgramSource> sources() const { return sources_; }
  std::span<const ProgramOutput> outputs() const { return given_.outputs; }
  uint32_t registers() const { return given_.registers; }
  /// Whether any source is read at shifted points, or the steps to these.
  bool shifts() const { return shifts_; }
  float step() const { return given_.step; }
  /// Whether the axes of normal maps are read.
  bool has_relief() const { return relief_; }
  /// Numbers of sets that sources and images name.
  uint32_t uv_sets() const { return uv_sets_; }
  uint32_t corner_sets() const { return corner_sets_; }
  bool empty() const { return given_.instructions.empty() && given_.constants.empty(); }

  /// Evaluates points [0, count) of `memory`, whose sources have been set.
  void run(ProgramMemory& memory, int count) const;

 private:
  friend class ProgramMemory;
  void check() const;
  void find_sources();

  ProgramDescription given_;
  std::vector<ProgramSource> sources_;
  bool shifts_ = false, relief_ = false;
  uint32_t uv_sets_ = 0, corner_sets_ = 0;
  uint64_t number_;  // unique among all programs of the process
};

/// Registers for a batch of points, in structure of arrays. One per thread, for one program after another.
class ProgramMemory {
 public:
  static constexpr int kPoints = 16;  // of a batch; a multiple of all vector lengths

  /// The calling thread's. It grows to the largest program that the thread has run.
  static ProgramMemory& of_thread();

  /// Must precede the sources of a batch.
  void prepare(const Program& program);
  void set(uint32_t first, int point, const Vec3& value) {
    for (uint32_t i = 0; i < 3; ++i) set(first + i, point, value[static_cast<int>(i)]);
  }
  void set(uint32_t number, int point, float value) { lanes(number)[point] = value; }
  /// Value of an output; a number in all three components.
  Rgb get(const ProgramOutput& output, int point) {
    const float* first = lanes(output.first) + point;
    return output.is_number ? Rgb(*first) : Rgb(first[0], first[kPoints], first[2 * kPoints]);
  }

  float* lanes(uint32_t number) { return values_.data() + static_cast<size_t>(number) * kPoints; }

 private:
  AlignedArray<float> values_{0};
  uint64_t program_ = 0;  // number of the program whose constants the registers hold
};

}  // namespace velour

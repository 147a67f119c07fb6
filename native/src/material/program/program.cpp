#include "material/program/program.h"

#include <algorithm>
#include <atomic>
#include <string>
#include <utility>
#include "base/error.h"
#include "material/program/operands.h"
#include "material/surface_site.h"

namespace velour {
namespace {

uint64_t next_number() {
  static std::atomic<uint64_t> last{0};
  return ++last;
}

/// Checks one instruction after another; throws Error(invalid_argument).
class Checker {
 public:
  explicit Checker(const ProgramDescription& given) : given_(given), written_(given.registers, false) {
    std::fill_n(written_.begin(), given.constants.size(), true);
  }

  void check(size_t index) {
    const Instruction& at = given_.instructions[index];
    const int operation = static_cast<int>(at.operation);
    where_ = "Program instruction " + std::to_string(index);
    if (operation < 0 || operation >= kOperations) {
      refuse(where_ + " has operation " + std::to_string(operation) + "; operations are 0 to " +
             std::to_string(kOperations - 1) + ".");
    }
    const Signature& signs = signature(at.operation);
    where_ += std::string(" (") + signs.name + ")";
    for (size_t i = 0; i < at.choice.size(); ++i) check_choice(at, signs, i);
    check_table(at, signs);
    if (at.operation == Operation::image && static_cast<size_t>(at.choice[0]) >= given_.images.size()) {
      refuse(where_ + " names image " + std::to_string(at.choice[0]) + ", but the program has " +
             std::to_string(given_.images.size()) + " images.");
    }
    for (size_t i = 0; i < at.input.size() && signs.inputs[i] > 0; ++i) {
      check_written(at.input[i], signs.inputs[i], "input " + std::to_string(i));
    }
    write(at.output, signs.outputs);
  }

  void check_written(uint32_t first, uint32_t count, const std::string& what) const {
    if (!fits(first, count)) refuse_range(first, count, what);
    for (uint32_t i = 0; i < count; ++i) {
      if (!written_[first + i]) {
        refuse(where_ + ": " + what + " reads register " + std::to_string(first + i) +
               ", which nothing before it writes.");
      }
    }
  }

  void at_output(size_t index) { where_ = "Program output " + std::to_string(index); }

 private:
  bool fits(uint32_t first, uint32_t count) const {
    return first < given_.registers && count <= given_.registers - first;
  }
  [[noreturn]] void refuse_range(uint32_t first, uint32_t count, const std::string& what) const {
    refuse(where_ + ": " + what + " needs registers " + std::to_string(first) + " to " +
           std::to_string(uint64_t{first} + count - 1) + ", but the program has " + std::to_string(given_.registers) +
           ".");
  }
  void check_choice(const Instruction& at, const Signature& signs, size_t i) const {
    if (at.choice[i] >= 0 && at.choice[i] <= signs.last_choice[i]) return;
    refuse(where_ + ": choice " + std::to_string(i) + " is " + std::to_string(at.choice[i]) +
           "; it must be between 0 and " + std::to_string(signs.last_choice[i]) + ".");
  }
  void check_table(const Instruction& at, const Signature& signs) const {
    const uint32_t row = signs.table_row;
    const bool inside = at.table <= given_.tables.size() && at.table_size <= given_.tables.size() - at.table;
    const bool whole = row == 0 ? at.table_size == 0 : at.table_size % row == 0 && at.table_size >= signs.least_table;
    if (inside && whole) return;
    refuse(
        where_ + " has a table of " + std::to_string(at.table_size) + " values from " + std::to_string(at.table) +
        ", but it needs " +
        (row == 0 ? "none" : "at least " + std::to_string(signs.least_table) + " in rows of " + std::to_string(row)) +
        ", and the tables of the program have " + std::to_string(given_.tables.size()) + " values.");
  }
  void write(uint32_t first, uint32_t count) {
    if (!fits(first, count)) refuse_range(first, count, "its output");
    for (uint32_t i = first; i < first + count; ++i) {
      if (written_[i]) refuse(where_ + " writes register " + std::to_string(i) + ", which already has a value.");
      written_[i] = true;
    }
  }

  const ProgramDescription& given_;
  std::vector<bool> written_;
  std::string where_;
};

void require_at_most(size_t count, size_t most, const char* what) {
  if (count <= most) return;
  refuse("A program cannot have " + std::to_string(count) + " " + what + "; at most " + std::to_string(most) +
         " are supported.");
}

}  // namespace

Program::Program(ProgramDescription description) : given_(std::move(description)), number_(next_number()) {
  check();
  find_sources();
}

void Program::check() const {
  require_at_most(given_.registers, kMaxRegisters, "registers");
  require_at_most(given_.constants.size(), given_.registers, "constants in its registers");
  require_at_most(given_.instructions.size(), kMaxInstructions, "instructions");
  require_at_most(given_.tables.size(), kMaxTableValues, "values in tables");
  require_at_most(given_.outputs.size(), kMaxOutputs, "outputs");
  Checker checker(given_);
  for (size_t i = 0; i < given_.instructions.size(); ++i) checker.check(i);
  for (size_t i = 0; i < given_.outputs.size(); ++i) {
    checker.at_output(i);
    if (given_.outputs[i].computed) {
      checker.check_written(given_.outputs[i].first, given_.outputs[i].is_number ? 1 : 3, "it");
    }
  }
}

void Program::find_sources() {
  for (const Instruction& at : given_.instructions) {
    const auto set = static_cast<uint32_t>(at.choice[1]);
    if (at.operation != Operation::source) continue;
    const ProgramSource source{static_cast<Source>(at.choice[0]), set, static_cast<Shift>(at.choice[2]), at.output};
    if (source.kind == Source::uv) uv_sets_ = std::max(uv_sets_, set + 1);
    if (source.kind == Source::corner) corner_sets_ = std::max(corner_sets_, set + 1);
    shifts_ |= source.shift != Shift::none || source.kind == Source::step_x || source.kind == Source::step_y;
    relief_ |= source.kind >= Source::map_tangent && source.kind <= Source::map_normal;
    sources_.push_back(source);
  }
}

std::shared_ptr<const Program> Program::only(uint32_t outputs) const {
  ProgramDescription part = given_;
  std::vector<bool> needed(given_.registers, false);
  const auto need = [&](uint32_t first, uint32_t count) { std::fill_n(needed.begin() + first, count, true); };
  for (size_t i = 0; i < part.outputs.size(); ++i) {
    ProgramOutput& output = part.outputs[i];
    output.computed &= (outputs >> i & 1) != 0;
    if (output.computed) need(output.first, output.is_number ? 1 : 3);
  }
  part.instructions.clear();
  for (auto at = given_.instructions.rbegin(); at != given_.instructions.rend(); ++at) {
    const Signature& signs = signature(at->operation);
    const auto first = needed.begin() + at->output;
    if (std::none_of(first, first + signs.outputs, [](bool is) { return is; })) continue;
    for (size_t i = 0; i < at->input.size() && signs.inputs[i] > 0; ++i) need(at->input[i], signs.inputs[i]);
    part.instructions.push_back(*at);
  }
  std::reverse(part.instructions.begin(), part.instructions.end());
  return std::make_shared<const Program>(std::move(part));
}

ProgramMemory& ProgramMemory::of_thread() {
  thread_local ProgramMemory memory;
  return memory;
}

void ProgramMemory::prepare(const Program& program) {
  if (program_ == program.number_) return;
  const size_t size = static_cast<size_t>(program.registers()) * kPoints;
  if (values_.size() < size) values_ = aligned_zeros(size);
  for (size_t i = 0; i < program.given_.constants.size(); ++i) {
    std::fill_n(lanes(static_cast<uint32_t>(i)), kPoints, program.given_.constants[i]);
  }
  program_ = program.number_;
}

namespace {

void run_image(const Operands& operands, const ProgramImage& image) {
  operands.each([&](int point) {
    const Vec2 place(operands.vector(0, point));
    operands.set(0, point, image.color ? image.color->at_point(place) : Rgb(image.number->at_point(place)));
  });
}

/// Copies the last point's inputs to the points beyond it. SIMD kernels choose algorithms and numbers of octaves by all
/// points of a vector, so what an earlier program left there would change the last bits.
void fill_unused(const Operands& operands) {
  const Signature& signs = signature(operands.at.operation);
  for (size_t i = 0; i < operands.at.input.size(); ++i) {
    for (uint32_t c = 0; c < signs.inputs[i]; ++c) {
      float* lanes = operands.registers + (static_cast<size_t>(operands.at.input[i]) + c) * Operands::kPoints;
      std::fill(lanes + operands.count, lanes + Operands::kPoints, lanes[operands.count - 1]);
    }
  }
}

void run_one(const Operands& operands) {
  switch (operands.at.operation) {
    case Operation::source:
    case Operation::image:
      return;  // by Program::run()
    case Operation::math:
      return run_math(operands);
    case Operation::vector_math:
      return run_vector_math(operands);
    case Operation::mix_color:
    case Operation::mix_number:
    case Operation::mix_vector:
    case Operation::combine:
    case Operation::separate:
    case Operation::ramp:
    case Operation::curves:
    case Operation::hue_saturation:
    case Operation::invert:
    case Operation::gamma:
    case Operation::bright_contrast:
      return run_color(operands);
    case Operation::clamp:
    case Operation::map_range:
    case Operation::map_range_vector:
      return run_ranges(operands);
    case Operation::mapping:
    case Operation::transform:
      return run_mapping(operands);
    case Operation::fresnel:
    case Operation::layer_weight:
    case Operation::normal_map:
    case Operation::bump:
      return run_view(operands);
    case Operation::noise:
    case Operation::wave:
      fill_unused(operands);
      return run_noise(operands);
    case Operation::voronoi:
      fill_unused(operands);
      return run_voronoi(operands);
    case Operation::gradient:
    case Operation::checker:
    case Operation::brick:
    case Operation::magic:
      return run_patterns(operands);
    case Operation::white_noise:
      return run_white_noise(operands);
  }
}

}  // namespace

void Program::run(ProgramMemory& memory, int count) const {
  for (const Instruction& at : given_.instructions) {
    const Operands operands{at, memory.lanes(0), count, given_.tables.data() + at.table};
    if (at.operation == Operation::image) {
      run_image(operands, given_.images[static_cast<size_t>(at.choice[0])]);
    } else {
      run_one(operands);
    }
  }
}

}  // namespace velour

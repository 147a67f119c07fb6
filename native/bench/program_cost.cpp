// Time of programs for each point, as JSON: a dirt mask (Noise, Color Ramp, Mix), and single textures.
#include <chrono>
#include <cstdio>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/simd.h"
#include "material/program/program.h"

using namespace velour;

namespace {

/// Adds instructions whose inputs are constants or outputs of earlier ones.
class Builder {
 public:
  uint32_t constant(const std::vector<float>& values) {
    const auto first = static_cast<uint32_t>(given_.constants.size());
    given_.constants.insert(given_.constants.end(), values.begin(), values.end());
    return first;
  }
  /// Constants must precede.
  uint32_t add(Operation operation, std::array<int32_t, 4> choice, const std::vector<uint32_t>& inputs,
               const std::vector<float>& table = {}) {
    Instruction at;
    at.operation = operation;
    at.choice = choice;
    std::copy(inputs.begin(), inputs.end(), at.input.begin());
    given_.registers = std::max(given_.registers, static_cast<uint32_t>(given_.constants.size()));
    at.output = given_.registers;
    at.table = static_cast<uint32_t>(given_.tables.size());
    at.table_size = static_cast<uint32_t>(table.size());
    given_.tables.insert(given_.tables.end(), table.begin(), table.end());
    given_.registers += signature(operation).outputs;
    given_.instructions.push_back(at);
    return at.output;
  }
  Program finish() { return Program(std::move(given_)); }

 private:
  ProgramDescription given_;
};

Program noise(int kind, float detail) {
  Builder b;
  const uint32_t zero = b.constant({0, 0, 0}), one = b.constant({1}), many = b.constant({detail}),
                 half = b.constant({0.5f}), two = b.constant({2});
  const uint32_t place = b.add(Operation::source, {static_cast<int32_t>(Source::object_position)}, {});
  b.add(Operation::noise, {2, kind, 1, 0}, {place, zero, one, many, half, two, zero, one, zero});
  return b.finish();
}

Program dirt() {
  Builder b;
  const uint32_t zero = b.constant({0, 0, 0}), five = b.constant({5}), two = b.constant({2}), half = b.constant({0.5f}),
                 one = b.constant({1}), paint = b.constant({0.6f, 0.1f, 0.1f}), mud = b.constant({0.1f, 0.07f, 0.04f});
  std::vector<float> ramp;
  for (int i = 0; i <= 256; ++i) ramp.insert(ramp.end(), 4, static_cast<float>(i) / 256);
  const uint32_t place = b.add(Operation::source, {static_cast<int32_t>(Source::object_position)}, {});
  const uint32_t mask = b.add(Operation::noise, {2, 0, 1, 0}, {place, zero, five, two, half, two, zero, one, zero});
  const uint32_t share = b.add(Operation::ramp, {1}, {mask}, ramp);
  b.add(Operation::mix_color, {0, 1, 0}, {share, paint, mud});
  return b.finish();
}

Program voronoi(int feature) {
  Builder b;
  const uint32_t zero = b.constant({0, 0, 0}), five = b.constant({5}), half = b.constant({0.5f}), one = b.constant({1}),
                 two = b.constant({2});
  const uint32_t place = b.add(Operation::source, {static_cast<int32_t>(Source::object_position)}, {});
  b.add(Operation::voronoi, {2, feature, 0, 0}, {place, zero, five, zero, half, two, one, half, one});
  return b.finish();
}

double nanoseconds(const Program& program, int points) {
  ProgramMemory& memory = ProgramMemory::of_thread();
  memory.prepare(program);
  const uint32_t place = program.sources()[0].first;
  double least = 1e9;
  for (int repeat = 0; repeat < 5; ++repeat) {
    constexpr int kRuns = 4000;
    const auto start = std::chrono::steady_clock::now();
    for (int run = 0; run < kRuns; ++run) {
      for (int i = 0; i < points; ++i) {
        memory.set(place, i, Vec3(0.01f * static_cast<float>(run), 0.3f * static_cast<float>(i), 0.2f));
      }
      program.run(memory, points);
    }
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - start;
    least = std::min(least, took.count() / (kRuns * points));
  }
  return least;
}

}  // namespace

int main() {
  const std::vector<std::pair<std::string, Program>> programs = [] {
    std::vector<std::pair<std::string, Program>> made;
    made.emplace_back("dirt mask", dirt());
    made.emplace_back("noise, 1 octave", noise(0, 0));
    made.emplace_back("noise, 8 octaves", noise(0, 7));
    made.emplace_back("voronoi f1", voronoi(0));
    made.emplace_back("voronoi smooth f1", voronoi(2));
    return made;
  }();
  std::printf("{\"simd\": \"%s\"", simd_target());
  for (const auto& [name, program] : programs) {
    std::printf(",\n \"%s\": {\"single\": %.1f, \"batch of 16\": %.1f}", name.c_str(), nanoseconds(program, 1),
                nanoseconds(program, ProgramMemory::kPoints));
  }
  std::printf("}\n");
}

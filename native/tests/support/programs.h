// Programs for tests.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "material/program/program.h"

namespace velour::test {

inline ProgramDescription description_of(Operation operation, const std::vector<int32_t>& choices,
                                         const std::vector<float>& inputs, const std::vector<float>& table = {}) {
  ProgramDescription given;
  Instruction at;
  at.operation = operation;
  std::copy(choices.begin(), choices.end(), at.choice.begin());
  uint32_t first = 0;
  for (size_t i = 0; i < at.input.size() && signature(operation).inputs[i] > 0; ++i) {
    at.input[i] = first;
    first += signature(operation).inputs[i];
  }
  at.output = static_cast<uint32_t>(inputs.size());
  at.table_size = static_cast<uint32_t>(table.size());
  given.registers = at.output + signature(operation).outputs;
  given.constants = inputs;
  given.instructions = {at};
  given.tables = table;
  return given;
}

/// Output registers of one operation, whose input registers hold `inputs`.
inline std::vector<float> run_operation(Operation operation, const std::vector<int32_t>& choices,
                                        const std::vector<float>& inputs, const std::vector<float>& table = {}) {
  const Program program(description_of(operation, choices, inputs, table));
  ProgramMemory& memory = ProgramMemory::of_thread();
  memory.prepare(program);
  program.run(memory, 1);
  std::vector<float> found;
  for (uint32_t i = static_cast<uint32_t>(inputs.size()); i < program.registers(); ++i) {
    found.push_back(*memory.lanes(i));
  }
  return found;
}

}  // namespace velour::test

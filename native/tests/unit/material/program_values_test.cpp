// Operations against Blender's own evaluation of its nodes (scripts/program_values).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "support/programs.h"

namespace velour::program_values_test {
namespace {

struct BlenderValue {
  const char* blender;  // version
  Operation operation;
  std::vector<int32_t> choices;
  std::vector<float> inputs;  // of registers
  uint32_t first;             // register of the output
  std::vector<float> expected;
};

const std::vector<BlenderValue>& blender_values() {
  static const std::vector<BlenderValue> values{
#include "program_values.inc"
  };
  return values;
}

/// Geometry nodes do not clamp gradients, and clamp the channels of Combine Color; shader nodes do the opposite.
float expected_of(const BlenderValue& value, size_t i) {
  const float v = value.expected[i];
  return value.operation == Operation::gradient ? std::clamp(v, 0.0f, 1.0f) : v;
}
bool is_comparable(const BlenderValue& value) {
  return value.operation != Operation::combine || (value.inputs[0] >= 0 && value.inputs[0] <= 1);
}

TEST(ProgramValues, AreThoseOfBlender) {
  std::map<Operation, int> compared;
  for (const BlenderValue& value : blender_values()) {
    if (!is_comparable(value)) continue;
    const std::vector<float> found = test::run_operation(value.operation, value.choices, value.inputs);
    // Sines of large angles and of sines.
    const float bound = value.operation == Operation::magic ? 2e-5f : 3e-6f;
    for (size_t i = 0; i < value.expected.size(); ++i) {
      const float expected = expected_of(value, i);
      EXPECT_NEAR(found[value.first + i], expected, bound * std::max(1.0f, std::abs(expected)))
          << value.blender << ' ' << signature(value.operation).name << ' ' << testing::PrintToString(value.choices)
          << ", component " << value.first + i;
    }
    ++compared[value.operation];
  }
  EXPECT_GE(compared[Operation::noise], 60);
  EXPECT_GE(compared[Operation::voronoi], 200);
}

/// A control: values of other choices are refused.
TEST(ProgramValues, DependOnTheChoices) {
  int differs = 0, count = 0;
  for (const BlenderValue& value : blender_values()) {
    if (value.operation != Operation::noise || value.choices[0] == 0) continue;
    std::vector<int32_t> others = value.choices;
    --others[0];
    const std::vector<float> found = test::run_operation(value.operation, others, value.inputs);
    differs += std::abs(found[value.first] - value.expected[0]) > 1e-3f;
    ++count;
  }
  EXPECT_GE(differs, count * 9 / 10);
}

}  // namespace
}  // namespace velour::program_values_test

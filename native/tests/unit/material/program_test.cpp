#include "material/program/program.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/error.h"
#include "base/simd.h"
#include "material/normal_map.h"
#include "material/principled/principled_material.h"
#include "support/programs.h"

namespace velour::program_test {
namespace {

using test::description_of;
using test::run_operation;

std::string refusal(ProgramDescription given) {
  try {
    const Program program(std::move(given));
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::invalid_argument);
    return error.what();
  }
  return "accepted";
}

void expect_refused(const ProgramDescription& given, const std::string& words) {
  EXPECT_NE(refusal(given).find(words), std::string::npos) << refusal(given);
}

ProgramDescription sum() { return description_of(Operation::math, {0}, {1, 2, 0}); }

TEST(Program, RefusesWhatIsNotAProgram) {
  ASSERT_EQ(refusal(sum()), "accepted");
  ProgramDescription given = sum();
  given.instructions[0].operation = static_cast<Operation>(kOperations);
  expect_refused(given, "instruction 0 has operation 32");
  given = sum();
  given.instructions[0].choice[0] = 41;
  expect_refused(given, "(math): choice 0 is 41; it must be between 0 and 40");
  given = sum();
  given.instructions[0].choice[0] = -1;
  expect_refused(given, "choice 0 is -1");
  given = sum();
  given.instructions[0].input[1] = 3;
  expect_refused(given, "input 1 reads register 3, which nothing before it writes");
  given = sum();
  given.instructions[0].input[1] = 0xffffffff;
  expect_refused(given, "needs registers 4294967295 to 4294967295, but the program has 4");
  given = sum();
  given.instructions[0].output = 2;
  expect_refused(given, "writes register 2, which already has a value");
  given = sum();
  given.instructions[0].output = 4;
  expect_refused(given, "its output needs registers 4 to 4");
  given = sum();
  given.instructions[0].table_size = 1;
  given.tables = {1};
  expect_refused(given, "it needs none");
  given = sum();
  given.outputs = {{.first = 2, .is_number = false}};
  expect_refused(given, "Program output 0: it needs registers 2 to 4");
  given = sum();
  given.registers = Program::kMaxRegisters + 1;
  expect_refused(given, "at most 16384");
  given = sum();
  given.outputs.assign(17, {.first = 0, .is_number = true});
  expect_refused(given, "cannot have 17 outputs");
  given = description_of(Operation::image, {0}, {0, 0, 0});
  expect_refused(given, "names image 0, but the program has 0 images");
  given = description_of(Operation::ramp, {1}, {0.5f}, std::vector<float>(9, 0.0f));
  expect_refused(given, "at least 8 in rows of 4");
  given = description_of(Operation::ramp, {1}, {0.5f}, std::vector<float>(8, 0.0f));
  given.instructions[0].table = 0xffffffff;
  expect_refused(given, "from 4294967295");
}

TEST(Program, RunsInstructionsInOrder) {
  // (1 + 2) * (1 + 2)
  ProgramDescription given = sum();
  Instruction square;
  square.operation = Operation::math;
  square.choice[0] = static_cast<int32_t>(MathOperation::multiply);
  square.input = {3, 3, 2};
  square.output = 4;
  given.registers = 5;
  given.instructions.push_back(square);
  given.outputs = {{.first = 4, .is_number = true}};
  const Program program(given);
  ProgramMemory& memory = ProgramMemory::of_thread();
  memory.prepare(program);
  program.run(memory, ProgramMemory::kPoints);
  for (int i = 0; i < ProgramMemory::kPoints; ++i) EXPECT_EQ(memory.get(program.outputs()[0], i), Rgb(9.0f));
}

TEST(Program, OnlyComputesTheOutputsAskedFor) {
  ProgramDescription given = sum();
  Instruction uv;
  uv.operation = Operation::source;
  uv.choice = {static_cast<int32_t>(Source::uv), 2, 0, 0};
  uv.output = 4;
  given.registers = 7;
  given.instructions.push_back(uv);
  given.outputs = {{.first = 3, .is_number = true}, {.first = 4}};
  const Program program(given);
  EXPECT_EQ(program.sources().size(), 1u);
  EXPECT_EQ(program.uv_sets(), 3u);
  const auto first = program.only(1), second = program.only(2);
  EXPECT_TRUE(first->sources().empty());
  EXPECT_EQ(first->uv_sets(), 0u);
  EXPECT_TRUE(first->outputs()[0].computed);
  EXPECT_FALSE(first->outputs()[1].computed);
  EXPECT_EQ(second->sources().size(), 1u);
}

/// The last register of a batch is the same on every instruction set and for every number of points.
TEST(Program, GivesTheSameBitsEverywhere) {
  const std::vector<float> inputs{1.3f, -2.7f, 0.4f, 0.7f, 2, 3.4f, 0.6f, 1.9f, 0.3f, 1.1f, 0.5f};
  const std::string before = simd_target();
  std::vector<float> noise, cells;
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(select_simd_target(target.c_str()));
    const auto n = run_operation(Operation::noise, {3, 0, 1, 1}, inputs);
    const auto v = run_operation(Operation::voronoi, {3, 2, 0, 1}, inputs);
    if (noise.empty()) noise = n, cells = v;
    EXPECT_EQ(n, noise) << target;
    EXPECT_EQ(v, cells) << target;
  }
  select_simd_target(before.c_str());
}

/// Registers of the output at one point. `stale`: what an earlier program left in the inputs at all other points.
std::vector<float> run_beside(const ProgramDescription& given, float stale) {
  const Program program(given);
  ProgramMemory& memory = ProgramMemory::of_thread();
  memory.prepare(program);
  const auto inputs = static_cast<uint32_t>(given.constants.size());
  for (uint32_t i = 0; i < inputs; ++i) {
    for (int point = 1; point < ProgramMemory::kPoints; ++point) memory.set(i, point, stale);
  }
  program.run(memory, 1);
  std::vector<float> found;
  for (uint32_t i = inputs; i < given.registers; ++i) found.push_back(*memory.lanes(i));
  return found;
}

/// The kernels decide by all points of a vector: smooth cells or not, the number of octaves.
TEST(Program, DependsOnlyOnThePointsInUse) {
  const std::vector<float> sharp{1.3f, -2.7f, 0.4f, 0.7f, 2, 0, 0.6f, 1.9f, 0, 1.1f, 0.5f};
  const std::vector<float> octaves{1.3f, -2.7f, 0.4f, 0, 2, 1, 0.6f, 1e4f, 0.3f, 1.1f, 0};
  constexpr int smooth_f1 = 2, multifractal = 1;
  for (const ProgramDescription& given : {description_of(Operation::voronoi, {2, smooth_f1, 0, 0}, sharp),
                                          description_of(Operation::noise, {2, multifractal, 0, 1}, octaves)}) {
    const std::vector<float> expected = run_beside(given, 0);
    for (const float stale : {1.0f, 14.5f, std::nanf("")}) {
      EXPECT_EQ(run_beside(given, stale), expected) << signature(given.instructions[0].operation).name << ' ' << stale;
    }
  }
}

TEST(Program, ClampsMapsOfEqualLimitsByEveryCurve) {
  for (int curve = 0; curve < 4; ++curve) {
    const auto mapped = [&](int clamps) {
      return run_operation(Operation::map_range, {curve, clamps}, {0.3f, 0.5f, 0.5f, 1, 2, 4})[0];
    };
    EXPECT_EQ(mapped(1), 1) << curve;
    EXPECT_EQ(mapped(0), 0) << curve;
  }
}

TEST(Program, LooksUpRampsAndCurves) {
  const std::vector<float> rows{0, 0, 0, 1, 1, 0.5f, 0.25f, 0, 0, 1, 1, 1};
  const auto at = [&](float place, int interpolates) {
    return run_operation(Operation::ramp, {interpolates}, {place}, rows);
  };
  EXPECT_EQ(at(0.25f, 1), (std::vector<float>{0.5f, 0.25f, 0.125f, 0.5f}));
  EXPECT_EQ(at(0.75f, 0), (std::vector<float>{1, 0.5f, 0.25f, 0}));
  EXPECT_EQ(at(2, 1), (std::vector<float>{0, 1, 1, 1}));
  EXPECT_EQ(at(std::nanf(""), 1)[3], 1);
  const std::vector<float> line{0, 1, 0, 1, 0, 4};  // rows at -1 and 1
  const auto curve = [&](float factor, float value, int extends) {
    return run_operation(Operation::curves, {extends}, {factor, value, value, value, -1, 1}, line);
  };
  EXPECT_EQ(curve(1, 0, 0), (std::vector<float>{0.5f, 0.5f, 2}));
  EXPECT_EQ(curve(1, 2, 1), (std::vector<float>{1.5f, -0.5f, 6}));
  EXPECT_EQ(curve(1, 2, 0), (std::vector<float>{1, 0, 4}));
  EXPECT_EQ(curve(0.5f, 0, 0), (std::vector<float>{0.25f, 0.25f, 1}));
}

TEST(Program, AdjustsColors) {
  const auto near = [](const std::vector<float>& found, const Rgb& expected) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[static_cast<size_t>(i)], expected[i], 1e-6f) << i;
  };
  near(run_operation(Operation::invert, {}, {0.5f, 0.2f, 0.5f, 1}), {0.5f, 0.5f, 0.5f});
  near(run_operation(Operation::gamma, {}, {0.25f, -1, 4, 0.5f}), {0.5f, -1, 2});
  near(run_operation(Operation::bright_contrast, {}, {0.25f, 0.5f, 0, 0.1f, 1}), {0.1f, 0.6f, 0});
  near(run_operation(Operation::hue_saturation, {}, {0.5f, 1, 1, 1, 0.2f, 0.6f, 0.4f}), {0.2f, 0.6f, 0.4f});
  near(run_operation(Operation::hue_saturation, {}, {1, 1, 0.5f, 1, 1, 0, 0}), {0, 0.5f, 0.5f});  // half a turn
  near(run_operation(Operation::hue_saturation, {}, {0.5f, 0, 1, 1, 0.2f, 0.6f, 0.4f}), {0.6f, 0.6f, 0.6f});
}

TEST(Program, SeesTheViewThroughFresnel) {
  const Vec3 normal(0, 0, 1), view(std::sin(0.7f), 0, std::cos(0.7f));
  const auto with = [&](std::vector<float> values, float back) {
    for (const Vec3& v : {normal, view}) values.insert(values.end(), {v.x, v.y, v.z});
    values.push_back(back);
    return values;
  };
  // Fresnel's equations, with Snell's law.
  const auto exact = [](float eta) {
    const float c = std::cos(0.7f), t = std::sqrt(1 - (1 - c * c) / (eta * eta));
    const float s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
    return 0.5f * (s * s + p * p);
  };
  EXPECT_NEAR(run_operation(Operation::fresnel, {}, with({1.5f}, 0))[0], exact(1.5f), 1e-6f);
  EXPECT_NEAR(run_operation(Operation::fresnel, {}, with({1.2f}, 1))[0], exact(1 / 1.2f), 1e-6f);
  EXPECT_EQ(run_operation(Operation::fresnel, {}, with({2}, 1))[0], 1);  // total reflection
  const auto weight = run_operation(Operation::layer_weight, {}, with({0.25f}, 0));
  EXPECT_NEAR(weight[0], exact(1 / 0.75f), 1e-6f);
  EXPECT_NEAR(weight[1], 1 - std::sqrt(std::cos(0.7f)), 1e-6f);
}

/// A height that rises by 0.3 per meter along x tilts the normal by atan(0.3).
TEST(Program, BumpsTheNormalAgainstTheSlope) {
  const std::vector<float> inputs{1, 1, 0.5f, 0.5f + 0.3f * 0.01f, 0.5f, 0, 0, 1, 0.01f, 0, 0, 0, 0.01f, 0};
  const auto found = run_operation(Operation::bump, {}, inputs);
  const Vec3 expected = glm::normalize(Vec3(-0.3f, 0, 1));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[static_cast<size_t>(i)], expected[i], 1e-5f) << i;
  std::vector<float> none = inputs;
  none[0] = 0;
  EXPECT_NEAR(run_operation(Operation::bump, {}, none)[2], 1, 1e-6f);
}

TEST(Program, ReplacesParametersOfAMaterial) {
  ProgramDescription given = sum();
  given.outputs = {{.first = 0}};
  const auto program = std::make_shared<const Program>(given);
  const auto material =
      make_principled_material({.specular = 0}, {.base_color = TextureSlot<Rgb>::output_of(program, 3)}, 1);
  EXPECT_TRUE(material->varies());
  SurfaceSite site;
  site.computed[3] = {0.1f, 0.4f, 0.7f};
  ScratchArena arena;
  const Rgb f = material->prepare(direction(0.4f, 1), site, {}, arena)->eval_one({0, 0, 1}).f;
  EXPECT_NEAR(f.b / f.r, 7, 1e-3f);
}

TEST(Program, GivesTheNormalOfANormalMappedMaterial) {
  ProgramDescription given = sum();
  given.outputs = {{.first = 0, .is_normal = true}};
  const auto program = std::make_shared<const Program>(given);
  const auto flat = make_principled_material({.base_color = Rgb(0.5f), .specular = 0});
  const NormalMap map{.texture = TextureSlot<Rgb>::output_of(program, 0), .correction = ReliefCorrection::none};
  const auto bent = make_normal_mapped(flat, map, ReliefPart::diffuse);
  SurfaceSite site;
  site.computed[0] = direction(0.5f, 0);
  ScratchArena arena;
  const PreparedBrdf* point = bent->prepare({0, 0, 1}, site, {}, arena);
  const Vec3 wl = direction(0.5f, 0);
  // Lambert's f times the ratio of the cosines with both normals.
  EXPECT_NEAR(point->eval_one(wl).f.r, 0.5f / kPi / wl.z, 1e-4f);
}

TEST(MeshSets, TakeOneProgram) {
  ProgramDescription given = sum();
  given.outputs = {{.first = 0}};
  const auto one = std::make_shared<const Program>(given), other = std::make_shared<const Program>(given);
  MeshSets sets;
  sets.add(TextureSlot<Rgb>::output_of(one, 0));
  sets.add(TextureSlot<float>::output_of(one, 5));
  EXPECT_EQ(sets.outputs, 33u);
  EXPECT_THROW(sets.add(TextureSlot<Rgb>::output_of(other, 0)), Error);
}

}  // namespace
}  // namespace velour::program_test

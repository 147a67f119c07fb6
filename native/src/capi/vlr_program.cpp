#include <cmath>
#include "capi/conversions.h"
#include "material/program/program.h"

using namespace velour;
using namespace velour::capi;

namespace {

static_assert(VLR_OPERATION_MAP_RANGE_VECTOR + 1 == kOperations);
static_assert(VLR_SOURCE_STEP_Y + 1 == kSources);
static_assert(VLR_MATH_DEGREES == static_cast<int>(MathOperation::degrees));
static_assert(VLR_VECTOR_ROUND == static_cast<int>(VectorOperation::round));
static_assert(VLR_BLEND_VALUE == static_cast<int>(BlendMode::value));
static_assert(VLR_NOISE_HETERO_TERRAIN == static_cast<int>(NoiseKind::hetero_terrain));
static_assert(VLR_VORONOI_N_SPHERE_RADIUS == static_cast<int>(VoronoiFeature::n_sphere_radius));
static_assert(VLR_GRADIENT_RADIAL == static_cast<int>(GradientKind::radial));

template <class T>
std::vector<T> copied(const T* values, uint32_t count, const char* field) {
  if (count > 0) require(values, field);
  return std::vector<T>(values, values + count);
}

Instruction converted(const vlr_instruction& given) {
  Instruction at;
  at.operation = static_cast<Operation>(given.operation);
  std::copy(std::begin(given.choice), std::end(given.choice), at.choice.begin());
  std::copy(std::begin(given.input), std::end(given.input), at.input.begin());
  at.output = given.output;
  at.table = given.table;
  at.table_size = given.table_size;
  return at;
}

ProgramImage converted(const vlr_texture* texture, size_t index) {
  if (texture == nullptr || (!texture->color && !texture->number)) {
    refuse("vlr_program_desc.images[" + std::to_string(index) + "] is not a texture of pixels.");
  }
  return {texture->color, texture->number};
}

ProgramOutput converted(const vlr_program_output& output) {
  require_choice(output.kind, VLR_VALUE_NORMAL, "vlr_program_output.kind");
  return {output.first, output.kind == VLR_VALUE_NUMBER, output.kind == VLR_VALUE_NORMAL};
}

void require_count(uint32_t count, size_t most, const char* field) {
  if (count <= most) return;
  refuse(std::string(field) + " is " + std::to_string(count) + "; at most " + std::to_string(most) + " are supported.");
}

ProgramDescription converted(const vlr_program_desc& desc) {
  require_count(desc.constant_count, Program::kMaxRegisters, "vlr_program_desc.constant_count");
  require_count(desc.instruction_count, Program::kMaxInstructions, "vlr_program_desc.instruction_count");
  require_count(desc.table_count, Program::kMaxTableValues, "vlr_program_desc.table_count");
  require_count(desc.image_count, Program::kMaxImages, "vlr_program_desc.image_count");
  require_count(desc.output_count, Program::kMaxOutputs, "vlr_program_desc.output_count");
  ProgramDescription given;
  if (!(desc.step > 0.0f) || !std::isfinite(desc.step)) refuse("vlr_program_desc.step must be a positive number.");
  given.registers = desc.registers;
  given.step = desc.step;
  given.constants = copied(desc.constants, desc.constant_count, "vlr_program_desc.constants");
  given.tables = copied(desc.tables, desc.table_count, "vlr_program_desc.tables");
  if (desc.instruction_count > 0) require(desc.instructions, "vlr_program_desc.instructions");
  for (uint32_t i = 0; i < desc.instruction_count; ++i) given.instructions.push_back(converted(desc.instructions[i]));
  if (desc.image_count > 0) require(desc.images, "vlr_program_desc.images");
  for (uint32_t i = 0; i < desc.image_count; ++i) given.images.push_back(converted(desc.images[i], i));
  if (desc.output_count > 0) require(desc.outputs, "vlr_program_desc.outputs");
  for (uint32_t i = 0; i < desc.output_count; ++i) given.outputs.push_back(converted(desc.outputs[i]));
  return given;
}

}  // namespace

void vlr_program_desc_init(vlr_program_desc* desc) {
  *desc = {};
  desc->struct_size = sizeof(vlr_program_desc);
  desc->step = 1.0f;
}

vlr_status vlr_program_create(const vlr_program_desc* desc, vlr_program** out) {
  return guard([&] {
    require(out, "out");
    const auto given = read_options(desc, vlr_program_desc_init, "vlr_program_desc");
    *out = new vlr_program{std::make_shared<const Program>(converted(given))};
  });
}

void vlr_program_free(vlr_program* program) { delete program; }

vlr_status vlr_texture_of_program(const vlr_program* program, uint32_t output, vlr_texture** out) {
  return guard([&] {
    require(program, "program");
    require(out, "out");
    const size_t count = program->program->outputs().size();
    if (output >= count) {
      refuse("The program has no output " + std::to_string(output) + "; it has " + std::to_string(count) +
             " outputs, counted from 0.");
    }
    auto texture = std::make_unique<vlr_texture>();
    texture->program = program->program;
    texture->output = output;
    *out = texture.release();
  });
}

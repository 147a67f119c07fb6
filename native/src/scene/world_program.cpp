#include "scene/world_program.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include "base/error.h"
#include "base/parallel.h"

namespace velour {
namespace {

Vec3 value_of(Source source, const Vec3& direction, WorldRays rays) {
  switch (source) {
    case Source::position:
    case Source::object_position:
      return direction;
    case Source::normal:
    case Source::object_normal:
    case Source::geometric_normal:
    case Source::incoming:
      return -direction;
    case Source::camera_ray:
      return Vec3(rays == WorldRays::camera ? 1.0f : 0.0f);
    case Source::shadow_ray:
      return Vec3(rays == WorldRays::shadow ? 1.0f : 0.0f);
    default:
      return Vec3(0.0f);
  }
}

bool depends_on_direction(Source source) { return value_of(source, Vec3(1, 0, 0), WorldRays::others) != Vec3(0.0f); }

float radiance_of(float value) { return std::isfinite(value) ? std::max(value, 0.0f) : 0.0f; }

}  // namespace

WorldProgram::WorldProgram(std::shared_ptr<const Program> program, size_t output) {
  if (output >= program->outputs().size() || output >= 32 || program->outputs()[output].is_normal) {
    throw Error(Status::invalid_argument, "Output " + std::to_string(output) + " of the world's program is no color.");
  }
  output_ = program->outputs()[output];
  program_ = program->only(uint32_t{1} << output);
  for (const ProgramSource& source : program_->sources()) even_ &= !depends_on_direction(source.kind);
}

void WorldProgram::look_up(const DirectionBatch& world, WorldRays rays, RgbBatch& radiance) const {
  ProgramMemory& memory = ProgramMemory::of_thread();
  memory.prepare(*program_);
  for (int begin = 0; begin < world.count; begin += ProgramMemory::kPoints) {
    const int count = std::min(ProgramMemory::kPoints, world.count - begin);
    for (const ProgramSource& source : program_->sources()) {
      for (int i = 0; i < count; ++i) {
        memory.set(source.first, i, value_of(source.kind, world.get(begin + i), rays));
      }
    }
    program_->run(memory, count);
    for (int i = 0; i < count; ++i) {
      const Rgb found = memory.get(output_, i);
      radiance.set(begin + i, {radiance_of(found.r), radiance_of(found.g), radiance_of(found.b)});
    }
  }
}

Environment WorldProgram::baked(int width, int height) const {
  if (even_) width = height = 1;
  std::vector<float> pixels(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
  parallel_pieces(static_cast<size_t>(height), 0, Progress(), [&](size_t y) {
    const float theta = kPi * (static_cast<float>(y) + 0.5f) / static_cast<float>(height);
    DirectionBatch batch;
    RgbBatch radiance;
    float* out = &pixels[3 * y * static_cast<size_t>(width)];
    for (int begin = 0; begin < width; begin += DirectionBatch::kCapacity) {
      batch.count = 0;
      for (int x = begin; x < std::min(width, begin + DirectionBatch::kCapacity); ++x) {
        const float phi = 2 * kPi * (0.5f - (static_cast<float>(x) + 0.5f) / static_cast<float>(width));
        batch.push({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
      }
      look_up(batch, WorldRays::others, radiance);
      for (int i = 0; i < batch.count; ++i, out += 3) {
        const Rgb found = radiance.get(i);
        out[0] = found.r;
        out[1] = found.g;
        out[2] = found.b;
      }
    }
  });
  if (even_) return Environment::constant({pixels[0], pixels[1], pixels[2]});
  return Environment::image({width, height, 3, pixels}, 1.0f, Mat3(1.0f));
}

}  // namespace velour

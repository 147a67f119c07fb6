#include "render/computed.h"

#include <algorithm>
#include <cmath>
#include "material/program/program.h"

namespace velour {
namespace {

constexpr float kRoundingSteps = 64;  // minimum step, in rounding errors of positions

/// The axes along which shifted points lie, as in Cycles (make_orthonormals): they depend on the normal alone.
void find_axes(const Vec3& normal, Vec3& x, Vec3& y) {
  x = normal.x != normal.y || normal.x != normal.z
          ? Vec3(normal.z - normal.y, normal.x - normal.z, normal.y - normal.x)
          : Vec3(normal.z - normal.y, normal.x + normal.z, -normal.y - normal.x);
  x = glm::normalize(x);
  y = glm::cross(normal, x);
}

/// Reads sources of a program at a hit and at points beside it.
class PlaceReader {
 public:
  PlaceReader(const ComputedPlace& place, const Program& program)
      : place_(place), side_(place.is_back() ? -1.0f : 1.0f) {
    hit_[0] = place.hit;
    if (program.shifts()) find_shifted(program.step() * place.step);
  }

  Vec3 read(const ProgramSource& source) const {
    const auto shift = static_cast<size_t>(source.shift);
    const Hit& hit = hit_[shift];
    const SurfacePoint& point = place_.point;
    switch (source.kind) {
      case Source::uv:
        return Vec3(place_.scene.texture(hit, source.set).uv, 0.0f);
      case Source::corner:
        return place_.scene.color(hit, source.set);
      case Source::position:
        return point.position + (shift > 0 ? step_[shift - 1] : Vec3(0.0f));
      case Source::object_position:
        return place_.scene.object_position(hit);
      case Source::normal:
        return side_ * point.shading_normal;
      case Source::object_normal:
        return object_normal();
      case Source::geometric_normal:
        return side_ * point.geometric_normal;
      case Source::incoming:
        return place_.incoming;
      case Source::backfacing:
        return Vec3(side_ < 0 ? 1.0f : 0.0f);
      case Source::map_tangent:
      case Source::map_bitangent:
      case Source::map_normal:
        return side_ *
               place_.scene.relief(place_.hit)[static_cast<int>(source.kind) - static_cast<int>(Source::map_tangent)];
      case Source::step_x:
        return step_[0];
      case Source::step_y:
        return step_[1];
    }
    return Vec3(0.0f);
  }

 private:
  void find_shifted(float asked) {
    const SurfacePoint& point = place_.point;
    const float step = std::max(asked, kRoundingSteps * point.error);
    find_axes(side_ * point.geometric_normal, step_[0], step_[1]);
    for (size_t i = 0; i < 2; ++i) {
      step_[i] *= step;
      const Vec2 move = place_.scene.barycentric_step(place_.hit, step_[i]);
      hit_[1 + i] = place_.hit;
      hit_[1 + i].u += move.x;
      hit_[1 + i].v += move.y;
    }
  }

  Vec3 object_normal() const {
    const Affine map = place_.scene.instances()[place_.hit.instance].place(place_.hit.time);
    const Vec3& n = place_.point.shading_normal;
    const Vec3 local(glm::dot(map.column(0), n), glm::dot(map.column(1), n), glm::dot(map.column(2), n));
    const float length = glm::length(local);
    return length > 0 ? side_ / length * local : Vec3(0.0f);
  }

  const ComputedPlace& place_;
  const float side_;
  Hit hit_[3];  // of no shift, x and y
  Vec3 step_[2] = {Vec3(0.0f), Vec3(0.0f)};
};

}  // namespace

void compute(const Program& program, const ComputedPlace& place, SurfaceSite& site) {
  ProgramMemory& memory = ProgramMemory::of_thread();
  memory.prepare(program);
  const PlaceReader reader(place, program);
  for (const ProgramSource& source : program.sources()) memory.set(source.first, 0, reader.read(source));
  for (size_t set = 0; set < program.uv_sets(); ++set) memory.footprint(set, 0) = site.place(set).footprint;
  program.run(memory, 1);
  const auto outputs = program.outputs();
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].computed) site.computed[i] = memory.get(outputs[i], 0);
  }
}

}  // namespace velour

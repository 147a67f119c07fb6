#include "render/path/vertex.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "material/material.h"
#include "material/normal_map.h"
#include "material/program/program.h"
#include "math/sphere/frame.h"
#include "render/path/shell_crossing.h"

namespace velour {

namespace {

constexpr float kMinPart = 0.125f;  // minimum share of a pixel's side

bool varies(const Scene& scene) {
  return std::ranges::any_of(scene.materials(), [](const SurfaceMaterial& m) { return m.material->varies(); });
}

}  // namespace

RaySides across(const RayCone& cone, const Vec3& direction) {
  const Frame frame = Frame::about(direction);
  return {cone.width * frame.x, cone.width * frame.y};
}

PixelFootprint::PixelFootprint(const Scene& scene, int width, int height, int camera_rays)
    : camera_(scene.camera()),
      needed_(varies(scene)),
      part_(std::max(kMinPart, 1.0f / std::sqrt(static_cast<float>(camera_rays)))) {
  const Vec2 window(camera_.window[1] - camera_.window[0], camera_.window[3] - camera_.window[2]);
  pitch_ = part_ * window / Vec2(static_cast<float>(width), static_cast<float>(height));
}

RayCone PixelFootprint::cone_along(const Vec3& direction, float time) const {
  const float side = std::sqrt(std::abs(pitch_.x * pitch_.y));
  if (camera_.type == Camera::Type::orthographic) return {side, 0.0f, part_};
  // A pixel lies at distance 1 / cosine from the eye, and its area appears scaled by the cosine.
  const float cosine = std::max(0.0f, -glm::dot(direction, camera_.place(time).column(2)));
  return {0.0f, side * std::sqrt(cosine) * cosine, part_};
}

RaySides PixelFootprint::sides(const Vec3& position, float time) const {
  const Affine place = camera_.place(time);
  const float scale = camera_.type == Camera::Type::orthographic ? 1.0f : camera_.depth(position, time);
  return {scale * pitch_.x * place.column(0), scale * pitch_.y * place.column(1)};
}

Mat2 texture_footprint(const RaySides& sides, const Vec3& direction, const Vec3& normal, const TexturePoint& texture) {
  const float slope =
      std::copysign(std::max(std::abs(glm::dot(normal, direction)), kMinSlope), glm::dot(normal, direction));
  const auto side = [&](const Vec3& s) {
    const Vec3 on_plane = s - glm::dot(normal, s) / slope * direction;
    return Vec2(glm::dot(texture.u_gradient, on_plane), glm::dot(texture.v_gradient, on_plane));
  };
  return {side(sides.x), side(sides.y)};
}

uint64_t untextured_instances(const Scene& scene) {
  const auto varies = [&](uint32_t number) {
    const SurfaceMaterial& material = scene.materials()[number];
    return material.uv_sets > 0 && material.material->varies();
  };
  return static_cast<uint64_t>(std::ranges::count_if(scene.instances(), [&](const Scene::Instance& i) {
    return !scene.meshes()[i.mesh].has_uvs() && std::ranges::any_of(i.materials, varies);
  }));
}

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
        return shift > 0 ? shifted_normal(hit) : object_normal();
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
      case Source::camera_ray:
        return Vec3(place_.kind == hidden::kFromCamera ? 1.0f : 0.0f);
      case Source::shadow_ray:
        return Vec3(place_.kind == hidden::kFromShadows ? 1.0f : 0.0f);
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

  Vec3 shifted_normal(const Hit& hit) const {
    const Mesh& mesh = place_.scene.traced_mesh(place_.scene.instances()[hit.instance]);
    const std::array<Vec3, 3> n = mesh.corner_normals(hit.triangle, hit.time);
    if (n[0] == n[1] && n[0] == n[2]) return object_normal();  // without the noise of rounding
    return side_ * glm::normalize(mesh.shading_normal(hit.triangle, {hit.u, hit.v}, hit.time));
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
  program.run(memory, 1);
  const auto outputs = program.outputs();
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].computed) site.computed[i] = memory.get(outputs[i], 0);
  }
}

namespace {

Vec3 facing(const Vec3& v, const Vec3& towards) { return glm::dot(v, towards) < 0.0f ? -v : v; }

/// The shading normal, turned with its face only: it may point behind the face, as normals that light foliage from
/// above do. Beyond 120 degrees the file's normals oppose its winding and are turned, too.
Vec3 turned_with_face(const SurfacePoint& point, const Vec3& ground) {
  const Vec3 normal = glm::dot(point.geometric_normal, ground) < 0.0f ? -point.shading_normal : point.shading_normal;
  return glm::dot(normal, ground) < -0.5f ? -normal : normal;
}

/// Frame about unit `z` with +x along `tangent` unless that is degenerate.
Frame frame_along(const Vec3& z, const Vec3& tangent) {
  const Vec3 x = tangent - glm::dot(tangent, z) * z;
  const float length_sq = glm::dot(x, x);
  if (!(length_sq > 1e-6f * glm::dot(tangent, tangent)) || !(length_sq > 0.0f)) return Frame::about(z);
  const Vec3 unit_x = x / std::sqrt(length_sq);
  return {unit_x, glm::cross(z, unit_x), z};
}

/// Whether a material with corrected normals takes the place of `surface`'s: its view is mirrored below the face.
bool turns(const SurfaceMaterial& surface, const SurfacePoint& point, const Vec3& wv) {
  if (!surface.turned) return false;
  const Vec3 ground = facing(point.geometric_normal, wv), normal = turned_with_face(point, ground);
  return with_mirror_above(normal, ground, wv) != normal;
}

}  // namespace

Vertex::Vertex(const SurfacePoint& point, const Vec3& wv_world, bool bends)
    : position(point.position),
      geometric_normal(facing(point.geometric_normal, wv_world)),
      // Twice the bound: once for this point, once for the position of the triangle in the ray tracer.
      offset(4.0f * point.error),
      through_offset(offset),
      rounding(point.rounding),
      terminator(glm::dot(point.geometric_normal, wv_world) < 0.0f ? 0.0f : point.terminator),
      surface(nullptr),
      material(nullptr),
      table(nullptr) {
  Vec3 normal = turned_with_face(point, geometric_normal);
  const float cosine = glm::dot(normal, wv_world);
  if (bends && cosine < kMinCosine) normal = glm::normalize(normal + (kMinCosine - cosine) * wv_world);
  frame = frame_along(normal, point.tangent);
  wv = frame.to_local(wv_world);
}

Vertex Vertex::seen(const Scene& scene, const Ray& ray, const Hit& hit, const RayCone& cone_at_origin,
                    const PixelFootprint* pixel) {
  const SurfaceMaterial& surface = scene.materials()[scene.material(hit)];
  if (surface.shell && scene.has_shell(hit)) {
    ShellCrossing crossing(scene, ray, hit);
    // Rays traced without regard to the shell see its top.
    if (crossing.find()) {
      const SurfacePoint place = crossing.surface(scene.surface(crossing.top()), surface.shell_shaded);
      return {scene, place, &crossing, ray, crossing.top(), cone_at_origin, pixel};
    }
  }
  return {scene, scene.surface(hit), nullptr, ray, hit, cone_at_origin, pixel};
}

Vertex::Vertex(const Scene& scene, const SurfacePoint& point, const ShellCrossing* crossing, const Ray& ray,
               const Hit& hit, const RayCone& cone_at_origin, const PixelFootprint* pixel)
    : Vertex(point, -ray.direction, !turns(scene.materials()[point.material], point, -ray.direction)) {
  surface = &scene.materials()[point.material];
  material = surface->material.get();
  if (turns(*surface, point, -ray.direction)) {
    material = surface->turned.get();
    site.ground = frame.to_local(geometric_normal);
  }
  time = ray.time;
  cone = cone_at_origin.at(hit.distance);
  transmits = surface->material->transmits();
  site.back = glm::dot(point.geometric_normal, ray.direction) > 0.0f;
  if (!surface->material->varies()) return;
  const TexturePoint texture = scene.texture(hit);
  const RaySides sides = pixel != nullptr ? pixel->sides(position, time) : across(cone, ray.direction);
  find_site(crossing != nullptr ? crossing->texture(texture) : texture, ray.direction, sides);
  if (surface->uv_sets > 1) find_others(scene, hit, ray.direction, sides);
  find_colors(scene, hit);
  if (surface->relief) find_relief(scene, hit);
  const uint8_t kind = pixel != nullptr ? hidden::kFromCamera : hidden::kFromBounces;
  if (surface->program) find_computed({scene, hit, point, -ray.direction, kind, this->cone.pixel()});
  if (crossing != nullptr && surface->holed()) {
    // At a point: a footprint would average over the holes, which the rays of a pixel do.
    site.footprint = Mat2(0.0f);
    through_offset += crossing->height();  // the structure in between is part of the capture
    site.beyond_outline = crossing->beyond_outline(surface->material->texels());
  }
}

Rgb Vertex::emission() const { return surface->emission + surface->material->emission(site); }

void Vertex::find_relief(const Scene& scene, const Hit& hit) {
  const Mat3 relief = scene.relief(hit);
  for (int i = 0; i < 3; ++i) site.relief[i] = (site.back ? -1.0f : 1.0f) * frame.to_local(relief[i]);
  site.ground = frame.to_local(geometric_normal);
}

void Vertex::find_others(const Scene& scene, const Hit& hit, const Vec3& direction, const RaySides& sides) {
  for (size_t set = 1; set < surface->uv_sets; ++set) {
    const TexturePoint texture = scene.texture(hit, set);
    site.others[set - 1] = {texture.uv, texture_footprint(sides, direction, geometric_normal, texture)};
  }
}

void Vertex::find_colors(const Scene& scene, const Hit& hit) {
  for (size_t set = 0; set < surface->color_sets; ++set) site.colors[set] = scene.color(hit, set);
}

void Vertex::find_computed(const ComputedPlace& place) {
  const Program& program = *surface->program;
  compute(program, place, site);
  site.ground = frame.to_local(geometric_normal);
  for (size_t i = 0; i < program.outputs().size(); ++i) {
    if (program.outputs()[i].is_normal) site.computed[i] = frame.to_local(site.computed[i]);
  }
}

void Vertex::find_site(const TexturePoint& texture, const Vec3& direction, const RaySides& sides) {
  site.uv = texture.uv;
  site.footprint = texture_footprint(sides, direction, geometric_normal, texture);
  if (glm::dot(texture.v_gradient, frame.y) < 0.0f) {
    frame.y = -frame.y;
    wv.y = -wv.y;
  }
}

}  // namespace velour

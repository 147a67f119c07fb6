#include "render/vertex.h"

#include "material/material.h"
#include "material/program/program.h"
#include "render/shell_crossing.h"

namespace velour {
namespace {

Vec3 facing(const Vec3& v, const Vec3& towards) { return glm::dot(v, towards) < 0.0f ? -v : v; }

/// Frame about unit `z` with +x along `tangent` unless that is degenerate.
Frame frame_along(const Vec3& z, const Vec3& tangent) {
  const Vec3 x = tangent - glm::dot(tangent, z) * z;
  const float length_sq = glm::dot(x, x);
  if (!(length_sq > 1e-6f * glm::dot(tangent, tangent)) || !(length_sq > 0.0f)) return Frame::about(z);
  const Vec3 unit_x = x / std::sqrt(length_sq);
  return {unit_x, glm::cross(z, unit_x), z};
}

}  // namespace

Vertex::Vertex(const SurfacePoint& point, const Vec3& wv_world)
    : position(point.position),
      geometric_normal(facing(point.geometric_normal, wv_world)),
      // Twice the bound: once for this point, once for the position of the triangle in the ray tracer.
      offset(4.0f * point.error),
      through_offset(offset),
      rounding(point.rounding),
      terminator(glm::dot(point.geometric_normal, wv_world) < 0.0f ? 0.0f : point.terminator),
      surface(nullptr),
      table(nullptr) {
  Vec3 normal = facing(point.shading_normal, geometric_normal);
  const float cosine = glm::dot(normal, wv_world);
  if (cosine < kMinCosine) normal = glm::normalize(normal + (kMinCosine - cosine) * wv_world);
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
    : Vertex(point, -ray.direction) {
  surface = &scene.materials()[point.material];
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
  if (surface->program) find_computed(scene, point, hit, -ray.direction);
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

void Vertex::find_computed(const Scene& scene, const SurfacePoint& point, const Hit& hit, const Vec3& incoming) {
  const Program& program = *surface->program;
  compute(program, {scene, hit, point, incoming, cone.pixel()}, site);
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

#include "render/lights/emissive_group.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "material/material.h"
#include "render/computed.h"

namespace velour {
namespace {

constexpr float kMinOfMean = 1.0f / 64;  // minimum luminance of a triangle, as a share of the material's mean
constexpr float kMaxLuminance = 1e20f;

float luminance_at(const SurfaceMaterial& m, const SurfaceSite& site) {
  const float light = luminance(m.emission + m.material->emission(site)) * m.material->alpha(site);
  return light > 0.0f ? std::min(light, kMaxLuminance) : 0.0f;
}

/// The parallelogram whose half is the triangle; for texture coordinate sets other than the first, the whole texture.
SurfaceSite site_of(const Mesh& mesh, uint32_t triangle, const TextureMap* placed) {
  if (!mesh.has_uvs()) return {};
  Vec2 uv[3];
  for (size_t k = 0; k < 3; ++k) {
    const Vec2 own = mesh.corner_uvs(triangle)[k];
    uv[k] = placed != nullptr ? placed->point(own) : own;
    if (!std::isfinite(uv[k].x + uv[k].y)) return {};
  }
  SurfaceSite site = SurfaceSite::everywhere();
  site.uv = 0.5f * (uv[1] + uv[2]);
  site.footprint = Mat2(uv[1] - uv[0], uv[2] - uv[0]);
  return site;
}

/// Whether the map scales areas of all orientations by the same factor.
bool is_similarity(const Affine& map, double& area_scale) {
  const Vec3d x(map.column(0)), y(map.column(1)), z(map.column(2));
  area_scale = glm::dot(x, x);
  const double slack = 1e-5 * area_scale;
  return std::abs(glm::dot(y, y) - area_scale) < slack && std::abs(glm::dot(z, z) - area_scale) < slack &&
         std::abs(glm::dot(x, y)) < slack && std::abs(glm::dot(y, z)) < slack && std::abs(glm::dot(z, x)) < slack;
}

Hit hit_of(const Scene& scene, const Scene::Instance& instance, uint32_t triangle, const Vec2& place) {
  Hit hit;
  hit.distance = 0;
  hit.geometric_normal = instance.normal_to_world * double_area(scene.traced_mesh(instance), triangle, {});
  hit.u = place.x;
  hit.v = place.y;
  hit.triangle = triangle;
  hit.instance = static_cast<uint32_t>(&instance - scene.instances().data());
  return hit;
}

/// As seen along the normal.
void compute_facing(const Program& program, const Scene& scene, const Hit& hit, SurfaceSite& site) {
  const SurfacePoint point = scene.surface(hit);
  compute(program, {scene, hit, point, point.geometric_normal}, site);
}

uint32_t slot_of(const Mesh& mesh, uint32_t triangle, const Scene::Instance& instance) {
  return std::min<uint32_t>(mesh.material_slot(triangle), static_cast<uint32_t>(instance.materials.size() - 1));
}

}  // namespace

bool emits(const SurfaceMaterial& m) { return !m.shell && (m.emission != Rgb(0.0f) || m.material->emits()); }

float mean_emission(const SurfaceMaterial& m, const Scene& scene, const Scene::Instance& instance, uint32_t triangle,
                    const TextureMap* placed) {
  if (!m.material->varies()) return luminance_at(m, {});
  const Mesh& mesh = scene.traced_mesh(instance);
  SurfaceSite own = site_of(mesh, triangle, placed), all = SurfaceSite::everywhere();
  const auto light = [&] { return std::max(luminance_at(m, own), kMinOfMean * luminance_at(m, all)); };
  if (m.color_sets == 0 && !m.program) return light();
  // Includes the corners, so that a triangle counts as emissive if any corner is, whatever the mean color is.
  constexpr Vec2 kPlaces[] = {{1 / 3.0f, 1 / 3.0f}, {0, 0}, {1, 0}, {0, 1}};
  float sum = 0;
  for (const Vec2& place : kPlaces) {
    for (size_t set = 0; set < m.color_sets; ++set)
      own.colors[set] = all.colors[set] = mesh.color(triangle, place, set);
    if (m.program) compute_facing(*m.program, scene, hit_of(scene, instance, triangle, place), own);
    sum += light();
  }
  return sum / static_cast<float>(std::size(kPlaces));
}

Vec3 double_area(const Mesh& mesh, uint32_t triangle, const Affine& object_to_world, float time) {
  const std::array<Vec3, 3> corner = mesh.corners(triangle, time);
  return glm::cross(object_to_world.vector(corner[1] - corner[0]), object_to_world.vector(corner[2] - corner[0]));
}

EmissiveGroup::EmissiveGroup(const Scene& scene, const Scene::Instance& instance, const Progress& progress) {
  const Mesh& mesh = scene.traced_mesh(instance);
  light_.assign(mesh.triangles().size(), kNone);
  std::vector<LightTree::Light> lights;
  for (uint32_t t = 0; t < light_.size(); ++t) {
    progress.check();
    const uint32_t slot = slot_of(mesh, t, instance);
    const SurfaceMaterial& material = scene.materials()[instance.materials[slot]];
    if (!material.drawn_to || !emits(material)) continue;
    const TextureMap* placed = instance.placements.empty() ? nullptr : &instance.placements[slot];
    const float power =
        0.5f * glm::length(double_area(mesh, t, {})) * mean_emission(material, scene, instance, t, placed);
    if (!(power > 0.0f) || !std::isfinite(power)) continue;
    LightTree::Light& light = lights.emplace_back(LightTree::Light{Bounds{}, power});
    for (int k = 0; k < 3; ++k) {
      const uint32_t v = mesh.triangles()[t][k];
      light.box.add(mesh.positions()[v]);
      for (size_t moved = v; moved < mesh.moved_positions().size(); moved += mesh.positions().size())
        light.box.add(mesh.moved_positions()[moved]);
    }
    light_[t] = static_cast<uint32_t>(triangle_.size());
    triangle_.push_back(t);
  }
  tree_ = LightTree(lights, progress);
}

double EmissiveGroup::power(const Mesh& mesh, const Affine& object_to_world) const {
  double scale;
  if (is_similarity(object_to_world, scale)) return scale * static_cast<double>(tree_.intensity());
  double sum = 0;
  for (uint32_t i = 0; i < triangle_.size(); ++i) {
    const auto stretch = glm::length(double_area(mesh, triangle_[i], object_to_world)) /
                         glm::length(double_area(mesh, triangle_[i], {}));
    sum += static_cast<double>(tree_.intensity(i)) * static_cast<double>(stretch);
  }
  return sum;
}

}  // namespace velour

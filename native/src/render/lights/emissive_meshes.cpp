#include "render/lights/emissive_meshes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "material/material.h"
#include "math/sphere/affine.h"
#include "render/path/shadow_queue.h"
#include "render/path/vertex.h"

namespace velour {

namespace {

constexpr float kMinOfMean = 1.0f / 64;  // minimum luminance of a triangle, as a share of the material's mean
constexpr float kMaxLuminance = 1e20f;

float luminance_at(const SurfaceMaterial& m, const SurfaceSite& site) {
  const float light = luminance(glm::abs(m.emission + m.material->emission(site))) * m.material->alpha(site);
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
  compute(program, {scene, hit, point, point.geometric_normal, hidden::kFromBounces}, site);
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

namespace {

constexpr uint32_t kNone = EmissiveGroup::kNone;
constexpr size_t kRayBatch = 64;
/// Mean cosine of an emissive mesh: between 1 for a plane that faces the viewer and 1/4 for a ball, whose area is four
/// times its visible disk.
constexpr float kMeanCosine = 0.5f;

/// Uniform in a triangle, without the fold of a square root [Hei19]: barycentric weights of its second and third
/// corner.
Vec2 in_triangle(float x, float y) { return y > x ? Vec2(0.5f * x, y - 0.5f * x) : Vec2(x - 0.5f * y, 0.5f * y); }

/// Everything that a group depends on.
struct GroupKey {
  uint32_t mesh;
  std::vector<uint32_t> materials;
  std::vector<float> placements;
  auto operator<=>(const GroupKey&) const = default;

  explicit GroupKey(const Scene::Instance& i) : mesh(i.traced), materials(i.materials) {
    for (const TextureMap& p : i.placements) {
      placements.insert(placements.end(), {p.map[0].x, p.map[0].y, p.map[1].x, p.map[1].y, p.shift.x, p.shift.y});
    }
  }
};

}  // namespace

EmissiveMeshes::EmissiveMeshes(const Scene& scene, const Progress& progress) : scene_(scene) {
  for (const SurfaceMaterial& m : scene.materials()) emits_.push_back(emits(m));
  if (std::ranges::find(emits_, 1) == emits_.end()) return;
  find_places(progress);
  if (places_.empty()) return;
  find_lights(progress);
  rays_ = std::make_unique<EmbreeScene>();
  rays_->share_meshes(scene.rays());
  for (const Place& place : places_) {
    const Scene::Instance& i = scene.instances()[place.instance];
    rays_->add_instance(i.traced, i.object_to_world, scene.traced_steps(i), i.hidden_from());
  }
  rays_->commit(1, nullptr, scene.rays().levels());
}

void EmissiveMeshes::find_places(const Progress& progress) {
  std::map<GroupKey, uint32_t> group_of;
  place_of_.assign(scene_.instances().size(), kNone);
  for (uint32_t k = 0; k < place_of_.size(); ++k) {
    const Scene::Instance& i = scene_.instances()[k];
    const bool emissive = std::ranges::any_of(i.materials, [&](uint32_t m) { return emits_[m] != 0; });
    constexpr uint8_t kAll = hidden::kFromBounces | hidden::kFromTransmission;
    if (!emissive || (i.hidden & kAll) == kAll) continue;
    const auto [found, is_new] = group_of.emplace(GroupKey(i), static_cast<uint32_t>(groups_.size()));
    if (is_new) groups_.emplace_back(scene_, i, progress);
    place_of_[k] = static_cast<uint32_t>(places_.size());
    places_.push_back({k, found->second, i.object_to_world.inverse(), kNone});
  }
}

void EmissiveMeshes::find_lights(const Progress& progress) {
  for (uint32_t p = 0; p < places_.size(); ++p) {
    progress.check();
    Place& place = places_[p];
    const Scene::Instance& i = scene_.instances()[place.instance];
    if (group(place).tree().empty() || (i.hidden & hidden::kFromBounces) != 0) continue;
    const auto power = static_cast<float>(group(place).power(scene_.traced_mesh(i), i.object_to_world));
    if (!(power > 0.0f) || !std::isfinite(power)) continue;
    place.light = static_cast<uint32_t>(lights_.size());
    lit_.push_back(p);
    lights_.push_back({i.box_in_world(group(place).tree().bounds()), kMeanCosine * power});
  }
}

bool EmissiveMeshes::holds(const Hit& hit) const {
  return !empty() && place(hit.instance) != nullptr && emits_[scene_.material(hit)] != 0;
}

bool EmissiveMeshes::draws(const Hit& hit) const {
  if (!holds(hit)) return false;
  const Place& at = *place(hit.instance);
  return at.light != kNone && group(at).light(hit.triangle) != kNone;
}

Hit EmissiveMeshes::sample(uint32_t light, const LightPlace& place, double x, float y, Vec3& direction) const {
  const Place& chosen = places_[lit_[light]];
  const Scene::Instance& instance = scene_.instances()[chosen.instance];
  const Mesh& mesh = scene_.traced_mesh(instance);
  const EmissiveGroup& of = group(chosen);
  const uint32_t triangle = of.triangle(of.tree().choose({chosen.to_object.point(place.position)}, x));
  const Vec2 weights = in_triangle(static_cast<float>(x), y);
  const float time = place.time;
  const Vec3 to_point = instance.place(time).point(mesh.position(triangle, weights, time)) - place.position;
  const float distance = glm::length(to_point);
  direction = distance > 0.0f ? to_point / distance : Vec3(0.0f);
  Hit hit{distance,  instance.normal_map(time) * double_area(mesh, triangle, {}, time),
          weights.x, weights.y,
          triangle,  chosen.instance};
  hit.time = time;
  return hit;
}

double EmissiveMeshes::pdf(const Vec3& position, const Vec3& direction, const Hit& hit, uint32_t& light) const {
  if (!draws(hit)) return 0;
  const Place& at = *place(hit.instance);
  const Scene::Instance& instance = scene_.instances()[hit.instance];
  const EmissiveGroup& of = group(at);
  const Vec3 twice = double_area(scene_.traced_mesh(instance), hit.triangle, instance.place(hit.time), hit.time);
  const auto facing = static_cast<double>(0.5f * std::abs(glm::dot(direction, twice)));
  const double distance = static_cast<double>(hit.distance);
  const double chosen = of.tree().probability({at.to_object.point(position)}, of.light(hit.triangle));
  light = at.light;
  return facing > 0 ? chosen * distance * distance / facing : 0;
}

bool EmissiveMeshes::stops(const Hit& hit) const {
  if ((scene_.instances()[hit.instance].hidden & hidden::kFromShadows) != 0) return false;
  const SurfaceMaterial& material = scene_.materials()[scene_.material(hit)];
  return !material.shell && material.material->opaque() && !material.hides_backs();
}

void EmissiveMeshes::meet(std::span<const Ray> rays, std::vector<EmissiveHit>& found, const RayKinds& kinds) const {
  Ray left[kRayBatch];
  Hit hit[kRayBatch], passed[kRayBatch];
  uint8_t kind[kRayBatch];
  size_t number[kRayBatch], count = rays.size();
  for (size_t i = 0; i < count; ++i) {
    left[i] = rays[i];
    kind[i] = kinds[i];
    number[i] = i;
  }
  while (count > 0) {
    rays_->intersect({left, count}, hit, {.each = {kind, count}});
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
      if (hit[i].instance == kNoHit) continue;
      hit[i].instance = places_[hit[i].instance].instance;
      if (!same_crossing(hit[i], passed[i]) && holds(hit[i])) found.push_back({number[i], hit[i]});
      if (stops(hit[i])) continue;
      passed[kept] = hit[i];
      left[kept] = left[i];
      kind[kept] = kind[i];
      number[kept] = number[i];
      go_beyond(left[kept++], hit[i]);
    }
    count = kept;
  }
}

EmissiveMeshes::Light EmissiveMeshes::light(const Ray& ray, const Hit& hit, const RayCone& cone) const {
  constexpr float kMinFacing = 1e-3f, kRounding = 0x1p-20f;
  const Vertex vertex = Vertex::seen(scene_, ray, hit, cone, nullptr);
  const Material& material = *vertex.surface->material;
  const bool seen = !passes_back(*vertex.surface, ray, hit, hidden::kFromBounces);
  const float alpha =
      material.opaque() ? 1.0f : material.alpha(point_site(scene_, ray, hit, *vertex.surface, hidden::kFromBounces));
  const float facing = std::abs(glm::dot(ray.direction, vertex.geometric_normal));
  // An aimed ray starts slightly off the point that it was aimed from.
  const float distance = facing > kMinFacing
                             ? std::abs(glm::dot(vertex.position - ray.origin, vertex.geometric_normal)) / facing
                             : hit.distance;
  const float margin = vertex.offset / std::max(facing, kMinFacing) + kRounding * distance;
  return {(seen ? alpha : 0.0f) * vertex.emission(), std::max(0.0f, distance - margin)};
}

}  // namespace velour

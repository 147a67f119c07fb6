#include "render/lights/emissive_meshes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "math/sphere/affine.h"
#include "render/shadow_queue.h"
#include "render/vertex.h"

namespace velour {
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
    rays_->add_instance(i.traced, i.object_to_world, scene.traced_steps(i));
  }
  rays_->commit(1, nullptr, scene.rays().levels());
}

void EmissiveMeshes::find_places(const Progress& progress) {
  std::map<GroupKey, uint32_t> group_of;
  place_of_.assign(scene_.instances().size(), kNone);
  for (uint32_t k = 0; k < place_of_.size(); ++k) {
    const Scene::Instance& i = scene_.instances()[k];
    const bool emissive = std::ranges::any_of(i.materials, [&](uint32_t m) { return emits_[m] != 0; });
    if (!emissive || (i.hidden & hidden::kFromBounces) != 0) continue;
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
    if (group(place).tree().empty()) continue;
    const Scene::Instance& i = scene_.instances()[place.instance];
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

void EmissiveMeshes::meet(std::span<const Ray> rays, std::vector<EmissiveHit>& found) const {
  Ray left[kRayBatch];
  Hit hit[kRayBatch], passed[kRayBatch];
  size_t number[kRayBatch], count = rays.size();
  for (size_t i = 0; i < count; ++i) {
    left[i] = rays[i];
    number[i] = i;
  }
  while (count > 0) {
    rays_->intersect({left, count}, hit);
    size_t kept = 0;
    for (size_t i = 0; i < count; ++i) {
      if (hit[i].instance == kNoHit) continue;
      hit[i].instance = places_[hit[i].instance].instance;
      if (!same_crossing(hit[i], passed[i]) && holds(hit[i])) found.push_back({number[i], hit[i]});
      if (stops(hit[i])) continue;
      passed[kept] = hit[i];
      left[kept] = left[i];
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
  const float alpha = material.opaque() ? 1.0f : material.alpha(point_site(scene_, ray, hit, *vertex.surface));
  const float facing = std::abs(glm::dot(ray.direction, vertex.geometric_normal));
  // An aimed ray starts slightly off the point that it was aimed from.
  const float distance = facing > kMinFacing
                             ? std::abs(glm::dot(vertex.position - ray.origin, vertex.geometric_normal)) / facing
                             : hit.distance;
  const float margin = vertex.offset / std::max(facing, kMinFacing) + kRounding * distance;
  return {(seen ? alpha : 0.0f) * vertex.emission(), std::max(0.0f, distance - margin)};
}

}  // namespace velour


#include <cmath>
#include <iterator>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>
#include "scene/scene.h"

namespace velour {

void Scene::build_rays(int threads, const Progress* progress) {
  const auto check = [progress] {
    if (progress != nullptr) progress->check();
  };
  lift_shells(progress);
  if (!rays_) rays_ = std::make_unique<EmbreeScene>();
  std::vector<bool> traced(meshes_.size());
  for (const Instance& i : instances_) {
    if (i.top == nullptr) traced[i.mesh] = true;
  }
  mesh_rays_.resize(meshes_.size(), kNoHit);
  for (size_t m = 0; m < meshes_.size(); ++m) {
    check();
    trace(meshes_[m], traced[m], mesh_rays_[m]);
  }
  for (auto top = tops_.begin(); top != tops_.end();) {
    check();
    trace(top->second.mesh, top->second.is_shown, top->second.number);
    top = top->second.is_shown ? std::next(top) : tops_.erase(top);
  }
  rays_->clear_instances();
  for (Instance& i : instances_) {
    i.traced = i.top != nullptr ? i.top->number : mesh_rays_[i.mesh];
    rays_->add_instance(i.traced, i.object_to_world, traced_steps(i), i.hidden_from());
  }
  rays_->commit(threads, progress, stays_ ? EmbreeScene::Levels::one : EmbreeScene::Levels::two);
  stays_ = false;
  build_sides(threads);
  geometry_changed_ = false;
  bounds_ = bounds_of_instances();
}

void Scene::trace(const Mesh& mesh, bool is_traced, uint32_t& number) {
  if (is_traced == (number != kNoHit)) return;
  if (!is_traced) {
    rays_->set_mesh(number, {}, {});
    free_rays_.push_back(std::exchange(number, kNoHit));
    return;
  }
  const bool deforms = mesh.deforms() && camera_.shutter;
  const std::span<const Vec3> positions = deforms ? mesh.moved_positions() : mesh.positions();
  const unsigned steps = deforms ? mesh.steps() : 1;
  if (free_rays_.empty()) {
    number = rays_->add_mesh(positions, mesh.triangles(), steps);
  } else {
    rays_->set_mesh(free_rays_.back(), positions, mesh.triangles(), steps);
    number = free_rays_.back();
    free_rays_.pop_back();
  }
}

void Scene::drop_tops(uint32_t mesh) {
  for (auto top = tops_.lower_bound({mesh}); top != tops_.end() && top->first.front() == mesh; top = tops_.erase(top)) {
    geometry_changed_ = true;
    if (rays_) trace(top->second.mesh, false, top->second.number);
  }
}

namespace {

/// Maximum number of surfaces that a ray passes before next_crossing() gives up; the sides of a folded border overlap.
constexpr int kMaxAgainst = 64;
constexpr float kStep = 0x1p-20f;  // relative to the distance: the ray tracer's own error

uint32_t add_sides(const Mesh& mesh, bool deforms, EmbreeScene& to) {
  std::vector<uint32_t> vertices;
  std::vector<glm::uvec3> triangles;
  std::unordered_map<uint32_t, uint32_t> numbers;
  for (size_t t = mesh.first_side(); t < mesh.triangles().size(); ++t) {
    glm::uvec3 corner;
    for (int k = 0; k < 3; ++k) {
      const uint32_t vertex = mesh.triangles()[t][k];
      const auto [entry, is_new] = numbers.emplace(vertex, static_cast<uint32_t>(vertices.size()));
      if (is_new) vertices.push_back(vertex);
      corner[k] = entry->second;
    }
    triangles.push_back(corner);
  }
  std::vector<Vec3> positions;
  const std::span<const Vec3> from = deforms ? mesh.moved_positions() : mesh.positions();
  for (size_t step = 0; step < from.size(); step += mesh.positions().size()) {
    for (const uint32_t vertex : vertices) positions.push_back(from[step + vertex]);
  }
  return to.add_mesh(positions, triangles, deforms ? mesh.steps() : 1);
}

/// Distance along the ray to where it first crosses instance `of` inward or outward; infinite if it does not.
float next_crossing(const EmbreeScene& rays, uint32_t of, Ray ray, bool inwards) {
  for (int i = 0; i < kMaxAgainst && ray.near < ray.far; ++i) {
    Hit hit;
    rays.intersect(ray, hit);
    if (hit.instance == kNoHit) break;
    const bool leads_in = glm::dot(hit.geometric_normal, ray.direction) < 0;
    if (hit.instance == of && leads_in == inwards) return hit.distance;
    ray.near = std::nextafter(hit.distance * (1 + kStep), std::numeric_limits<float>::infinity());
  }
  return std::numeric_limits<float>::infinity();
}

}  // namespace

void Scene::build_sides(int threads) {
  sides_.reset();
  std::unordered_map<uint32_t, uint32_t> numbers;  // in sides_, by the number in rays_
  for (Instance& instance : instances_) {
    instance.sides = kNoHit;
    const Mesh& mesh = traced_mesh(instance);
    if (!mesh.has_sides()) continue;
    if (!sides_) sides_ = std::make_unique<EmbreeScene>();
    auto known = numbers.find(instance.traced);
    const bool deforms = mesh.deforms() && camera_.shutter;
    if (known == numbers.end()) known = numbers.emplace(instance.traced, add_sides(mesh, deforms, *sides_)).first;
    instance.sides = sides_->add_instance(known->second, instance.object_to_world, traced_steps(instance));
  }
  if (sides_) sides_->commit(threads, nullptr, rays_->levels());
}

Scene::ShellFoot Scene::shell_foot(const Hit& hit) const {
  const Instance& instance = instances_[hit.instance];
  const Mesh& mesh = traced_mesh(instance);
  if (hit.triangle < mesh.first_side()) return {hit};
  const Mesh::SidePoint point = mesh.on_side(hit.triangle, {hit.u, hit.v});
  const std::array<Vec3, 3> corner = mesh.corners(point.triangle, hit.time);
  ShellFoot foot{hit, true, 1 - point.height};
  foot.top.triangle = point.triangle;
  foot.top.u = point.uv.x;
  foot.top.v = point.uv.y;
  foot.top.geometric_normal = instance.normal_map(hit.time) * glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
  return foot;
}

float Scene::next_side(const Hit& hit, const Ray& ray, bool inwards) const {
  const uint32_t of = instances_[hit.instance].sides;
  return of != kNoHit ? next_crossing(*sides_, of, ray, inwards) : std::numeric_limits<float>::infinity();
}

float Scene::next_top(const Hit& hit, const Ray& ray, bool inwards) const {
  return next_crossing(*rays_, hit.instance, ray, inwards);
}

}  // namespace velour


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
    rays_->add_instance(i.traced, i.object_to_world);
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
  } else if (free_rays_.empty()) {
    number = rays_->add_mesh(mesh.positions(), mesh.triangles());
  } else {
    rays_->set_mesh(free_rays_.back(), mesh.positions(), mesh.triangles());
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

/// Maximum number of sides that a ray passes before next_side() gives up; the sides of a folded border overlap.
constexpr int kMaxAgainst = 64;
constexpr float kStep = 0x1p-20f;  // relative to the distance: the ray tracer's own error

uint32_t add_sides(const Mesh& mesh, EmbreeScene& to) {
  std::vector<Vec3> positions;
  std::vector<glm::uvec3> triangles;
  std::unordered_map<uint32_t, uint32_t> numbers;
  for (size_t t = mesh.first_side(); t < mesh.triangles().size(); ++t) {
    glm::uvec3 corner;
    for (int k = 0; k < 3; ++k) {
      const uint32_t vertex = mesh.triangles()[t][k];
      const auto [entry, is_new] = numbers.emplace(vertex, static_cast<uint32_t>(positions.size()));
      if (is_new) positions.push_back(mesh.positions()[vertex]);
      corner[k] = entry->second;
    }
    triangles.push_back(corner);
  }
  return to.add_mesh(positions, triangles);
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
    if (known == numbers.end()) known = numbers.emplace(instance.traced, add_sides(mesh, *sides_)).first;
    instance.sides = sides_->add_instance(known->second, instance.object_to_world);
  }
  if (sides_) sides_->commit(threads, nullptr, rays_->levels());
}

Scene::ShellFoot Scene::shell_foot(const Hit& hit) const {
  const Instance& instance = instances_[hit.instance];
  const Mesh& mesh = traced_mesh(instance);
  if (hit.triangle < mesh.first_side()) return {hit};
  const Mesh::SidePoint point = mesh.on_side(hit.triangle, {hit.u, hit.v});
  const glm::uvec3& corner = mesh.triangles()[point.triangle];
  const auto edge = [&](int k) { return mesh.positions()[corner[k]] - mesh.positions()[corner[0]]; };
  ShellFoot foot{hit, true, 1 - point.height};
  foot.top.triangle = point.triangle;
  foot.top.u = point.uv.x;
  foot.top.v = point.uv.y;
  foot.top.geometric_normal = instance.normal_to_world * glm::cross(edge(1), edge(2));
  return foot;
}

float Scene::next_side(const Hit& hit, Ray ray, bool inwards) const {
  const uint32_t of = instances_[hit.instance].sides;
  for (int i = 0; i < kMaxAgainst && of != kNoHit && ray.near < ray.far; ++i) {
    Hit side;
    sides_->intersect(ray, side);
    if (side.instance == kNoHit) break;
    const bool leads_in = glm::dot(side.geometric_normal, ray.direction) < 0;
    if (side.instance == of && leads_in == inwards) return side.distance;
    ray.near = std::nextafter(side.distance * (1 + kStep), std::numeric_limits<float>::infinity());
  }
  return std::numeric_limits<float>::infinity();
}

}  // namespace velour

#include <iterator>
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

}  // namespace velour

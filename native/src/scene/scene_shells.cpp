#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "base/error.h"
#include "scene/scene.h"

namespace velour {
namespace {

/// M^T M of the transform's linear part M, which measures object-space vectors in world space.
Mat3 metric_of(const Affine& map) {
  const Vec3 x = map.vector({1, 0, 0}), y = map.vector({0, 1, 0}), z = map.vector({0, 0, 1});
  return {{glm::dot(x, x), glm::dot(x, y), glm::dot(x, z)},
          {glm::dot(x, y), glm::dot(y, y), glm::dot(y, z)},
          {glm::dot(x, z), glm::dot(y, z), glm::dot(z, z)}};
}

}  // namespace

void ShellFolds::add(const Vec3 (&corner)[3], const Vec3 (&normal)[3], const ShellHeights& shell) {
  ++all;
  float stretch = 1, radius = least_radius;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const Vec3 edge = corner[next] - corner[k];
    const float curvature = glm::dot(normal[next] - normal[k], edge) / glm::dot(edge, edge);
    const float least = 1 + std::min(curvature * shell.bottom, curvature * shell.top);
    if (!(least < stretch)) continue;
    stretch = least;
    radius = std::min(least_radius, 1 / std::abs(curvature));
  }
  if (stretch > 0) return;
  ++triangles;
  least_radius = radius;
}

SurfaceMaterial& Scene::with_shell(uint32_t material, const char* to_what) {
  if (material < materials_.size() && materials_[material].shell) return materials_[material];
  throw Error(Status::invalid_argument,
              "Material " + std::to_string(material) + " has no silhouette (VOTF) to " + to_what + ".");
}

void Scene::set_shell_tile(uint32_t material, float metres) {
  SurfaceMaterial& surface = with_shell(material, "scale");
  if (!(metres >= 0 && std::isfinite(metres))) {
    throw Error(Status::invalid_argument, "The tile width of a silhouette (VOTF) is " + std::to_string(metres) +
                                              " m; it must be finite and at least 0.");
  }
  if (metres == surface.shell_tile) return;
  geometry_changed();
  surface.shell_tile = metres;
}

void Scene::set_shell_softness(uint32_t material, float widths) {
  SurfaceMaterial& surface = with_shell(material, "soften");
  if (!(widths >= 0 && widths < 1)) {
    throw Error(Status::invalid_argument, "The edge softness of a silhouette (VOTF) is " + std::to_string(widths) +
                                              " of the tile width; it must be at least 0 and below 1.");
  }
  ++revision_;
  surface.shell_softness = widths;
}

void Scene::lift_shells(const Progress* progress) {
  unlifted_ = 0;
  shell_warnings_.clear();
  for (auto& [key, top] : tops_) top.is_shown = false;
  for (Instance& instance : instances_) {
    instance.top = nullptr;
    instance.tile_width.clear();
    const bool any =
        std::ranges::any_of(instance.materials, [&](uint32_t m) { return materials_[m].shell != nullptr; });
    if (!any) continue;
    if (progress != nullptr) progress->check();
    lift(instance);
    if (std::ranges::none_of(instance.tile_width, [](float width) { return width > 0; })) ++unlifted_;
  }
}

void Scene::lift(Instance& instance) {
  std::vector<ShellHeights> height(instance.materials.size());
  instance.tile_width.assign(instance.materials.size(), 0.0f);
  for (uint32_t s = 0; s < height.size(); ++s) {
    const auto& shell = materials_[instance.materials[s]].shell;
    if (!shell) continue;
    const float given = materials_[instance.materials[s]].shell_tile, covered = tile_width(instance, s);
    instance.tile_width[s] = given > 0 && covered > 0 ? given : covered;
    height[s] = {shell->volume().bottom * instance.tile_width[s], shell->volume().top * instance.tile_width[s]};
  }
  // Instances that differ only in position and rotation share their top.
  const Mat3 metric = metric_of(instance.object_to_world);
  std::vector<uint32_t> key{instance.mesh};
  for (const ShellHeights& h : height) {
    for (const float limit : {h.bottom, h.top}) key.push_back(std::bit_cast<uint32_t>(limit));
  }
  for (int i = 0; i < 9; ++i) key.push_back(std::bit_cast<uint32_t>(metric[i / 3][i % 3]));
  auto found = tops_.find(key);
  if (found == tops_.end()) {
    ShellTop top{meshes_[instance.mesh].lifted(height, metric), {}};
    for (uint32_t s = 0; s < height.size(); ++s) top.folds.push_back(folds(instance, s, height[s]));
    top.is_shown = false;
    found = tops_.emplace(std::move(key), std::move(top)).first;
  }
  instance.top = &found->second;
  if (std::exchange(found->second.is_shown, true)) return;
  for (uint32_t s = 0; s < height.size(); ++s) warn_of_folds(instance, s, height[s]);
}

ShellFolds Scene::folds(const Instance& instance, uint32_t slot, const ShellHeights& shell) const {
  ShellFolds folds;
  if (!(instance.tile_width[slot] > 0)) return folds;
  const Mesh& mesh = meshes_[instance.mesh];
  const auto last = static_cast<uint32_t>(instance.materials.size() - 1);
  for (uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    if (std::min(mesh.material_slot(t), last) != slot) continue;
    const std::array<Vec3, 3> local = mesh.corner_normals(t);
    Vec3 corner[3], normal[3];
    for (int k = 0; k < 3; ++k) {
      corner[k] = instance.object_to_world.point(mesh.positions()[mesh.triangles()[t][k]]);
      normal[k] = glm::normalize(instance.normal_to_world * local[static_cast<size_t>(k)]);
    }
    folds.add(corner, normal, shell);
  }
  return folds;
}

void Scene::warn_of_folds(const Instance& instance, uint32_t slot, const ShellHeights& shell) {
  const ShellFolds& folds = instance.top->folds[slot];
  if (folds.triangles == 0) return;
  shell_warnings_.push_back(warning<WarningCode::silhouette_folds>({{"material", instance.materials[slot]},
                                                                    {"bottom", shell.bottom},
                                                                    {"top", shell.top},
                                                                    {"triangles", folds.triangles},
                                                                    {"sampled", folds.all},
                                                                    {"radius", folds.least_radius},
                                                                    {"tile", instance.tile_width[slot]}}));
}

/// Width in meters of a tile that covers one unit of the texture coordinates, averaged over the slot's triangles; 0 if
/// they have no area in texture space.
float Scene::tile_width(const Instance& instance, uint32_t slot) const {
  const Mesh& mesh = meshes_[instance.mesh];
  const ShellField& shell = *materials_[instance.materials[slot]].shell;
  const Mat2 map = instance.placements.empty() ? Mat2(1.0f) : instance.placements[slot].map;
  if (!mesh.has_uvs()) return 0;
  const auto last = static_cast<uint32_t>(instance.materials.size() - 1);
  double area = 0, tiles = 0;
  for (uint32_t t = 0; t < mesh.triangles().size(); ++t) {
    if (std::min(mesh.material_slot(t), last) != slot) continue;
    const glm::uvec3& corner = mesh.triangles()[t];
    const auto edge = [&](int k) {
      return Vec3d(instance.object_to_world.vector(mesh.positions()[corner[k]] - mesh.positions()[corner[0]]));
    };
    const auto uv = mesh.corner_uvs(t);
    const Vec2 d1 = map * (uv[1] - uv[0]), d2 = map * (uv[2] - uv[0]);
    const double covered = std::abs(static_cast<double>(d1.x * d2.y - d1.y * d2.x));
    if (!std::isfinite(covered)) continue;
    area += glm::length(glm::cross(edge(1), edge(2)));
    tiles += covered;
  }
  return tiles > 0 ? static_cast<float>(std::sqrt(area / tiles / static_cast<double>(shell.volume().aspect))) : 0.0f;
}

ShellFrame Scene::shell(const Hit& hit, const Vec3& direction) const {
  const Instance& instance = instances_[hit.instance];
  const Mesh& mesh = traced_mesh(instance);
  const Affine map = instance.place(hit.time);
  const Mat3 normal_map = instance.normal_map(hit.time);
  const std::array<Vec3, 3> corner = mesh.corners(hit.triangle, hit.time);
  std::array<Vec3, 3> normal = mesh.corner_normals(hit.triangle, hit.time);
  for (Vec3& n : normal) n = glm::normalize(normal_map * n);
  const auto edge = [&](size_t k) { return Vec3d(map.vector(corner[k] - corner[0])); };
  ShellFrame frame;
  const SurfaceMaterial& surface = materials_[material(hit)];
  frame.field = surface.shell.get();
  // Stored distances end at the reach; a softer edge would fill the shell.
  frame.softness = std::min(surface.shell_softness, 1.8f * frame.field->volume().reach);
  frame.scale = 1 / instance.tile_width[slot(hit)];
  const Vec3 mean = (1 - hit.u - hit.v) * normal[0] + hit.u * normal[1] + hit.v * normal[2];
  frame.normal = glm::normalize(glm::dot(mean, mean) > 0 ? mean : normal[0]);
  const std::span<const Vec2, 3> uv = mesh.corner_uvs(hit.triangle);
  const Vec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
  frame.uv = uv[0] + hit.u * d1 + hit.v * d2;
  // Expresses the tangential direction in terms of the edges, along which normal and texture coordinates are known.
  const Vec3d e1 = edge(1), e2 = edge(2), across = glm::cross(e1, e2);
  const Vec3 along = direction - glm::dot(direction, frame.normal) * frame.normal;
  const float length = glm::length(along);
  const double square = glm::dot(across, across);
  if (length > 0 && square > 0) {
    const Vec3 unit = along / length;
    const auto a = static_cast<float>(glm::dot(glm::cross(Vec3d(unit), e2), across) / square),
               b = static_cast<float>(glm::dot(glm::cross(e1, Vec3d(unit)), across) / square);
    frame.normal_turn = a * (normal[1] - normal[0]) + b * (normal[2] - normal[0]);
    frame.curvature = glm::dot(frame.normal_turn, unit);
    frame.uv_along = a * d1 + b * d2;
  }
  // A fold turns the top over where it is sharper than the shell is high.
  if (glm::dot(frame.normal, hit.geometric_normal) < 0) {
    frame.normal = -frame.normal;
    frame.normal_turn = -frame.normal_turn;
    frame.curvature = -frame.curvature;
  }
  if (const TextureMap* placed = placement(hit)) {
    frame.uv = placed->point(frame.uv);
    frame.uv_along = placed->map * frame.uv_along;
  }
  if (!std::isfinite(glm::dot(frame.uv + frame.uv_along, Vec2(1.0f)))) frame.uv = frame.uv_along = Vec2(0.0f);
  return frame;
}

}  // namespace velour

#include "scene/scene.h"

#include <algorithm>
#include <chrono>
#include <string>

#include "base/error.h"
#include "math/sphere/affine.h"

namespace velour {
namespace {

/// Bound of the rounding error of a world coordinate computed from terms of `magnitude`: a sum of three products in
/// object space, then of three products and a translation, takes 8 roundings relative to their absolute values; the
/// interpolation of positions and transforms of what moves takes 6 more, here and in the ray tracer.
float position_error(const Affine& map, const Vec3& magnitude, bool moves) {
  float largest = 0.0f;
  for (const float* m = map.m; m < map.m + 12; m += 4) {
    const float sum = std::abs(m[0]) * magnitude.x + std::abs(m[1]) * magnitude.y + std::abs(m[2]) * magnitude.z;
    largest = std::max(largest, sum + std::abs(m[3]));
  }
  return (moves ? 20.0f : 8.0f) * 0x1p-24f * largest;
}

void require_finite(const Affine& map, const char* what) {
  if (!map.finite()) refuse(std::string("The transform of ") + what + " contains a number that is not finite.");
}

/// Throws Error(invalid_argument) unless all rays of the camera are finite.
void require_rays(const Camera& camera) {
  const auto require_place = [](const Affine& place) {
    require_finite(place, "the camera");
    if (!place.invertible()) refuse("The transform of the camera is singular; its axes must span space.");
  };
  const auto require_window = [](std::span<const float, 4> edges) {
    const bool is_finite = std::ranges::all_of(edges, [](float x) { return std::isfinite(x); });
    if (is_finite && edges[0] != edges[1] && edges[2] != edges[3]) return;
    refuse(
        "The window of the camera is empty or contains a number that is not finite; left and right, bottom and top "
        "must be different numbers.");
  };
  require_place(camera.camera_to_world);
  for (const Affine& step : camera.steps) require_place(step);
  require_window(camera.window);
  for (const auto& edges : camera.windows) require_window(edges);
  const Aperture& a = camera.aperture;
  if (!(a.radius >= 0.0f) || !std::isfinite(a.radius + a.rotation)) {
    refuse("The aperture of the camera must have a finite radius of at least 0 and a finite rotation.");
  }
  if (!(a.focus > 0.0f) || !(a.ratio > 0.0f) || !std::isfinite(a.focus) || !std::isfinite(a.ratio)) {
    refuse("The focus distance and the aperture ratio of the camera must be finite and positive.");
  }
  if (!std::isfinite(camera.clip_start) || std::isnan(camera.clip_end)) {
    refuse("The clip distances of the camera must be numbers; only the end may be infinite.");
  }
}

void require_steps(std::span<const Affine> steps, const char* what) {
  if (steps.empty() || steps.size() > kMaxMotionSteps) {
    refuse(std::string("The motion of ") + what + " has " + std::to_string(steps.size()) +
           " transforms; it must have 1 to " + std::to_string(kMaxMotionSteps) + ".");
  }
  for (const Affine& step : steps) require_finite(step, what);
}

void require_placements(const std::vector<TextureMap>& placements, size_t materials) {
  if (!placements.empty() && placements.size() != materials) {
    refuse("An instance has " + std::to_string(materials) + " materials and " + std::to_string(placements.size()) +
           " texture placements; both numbers must be the same, or there must be no placements.");
  }
  if (!std::ranges::all_of(placements, &TextureMap::invertible)) {
    refuse("A texture placement contains a number that is not finite, or scales the texture to zero.");
  }
}

bool needs_tangents(const SurfaceMaterial& material) { return material.relief || material.brushed; }

/// Whether both materials' shells lift meshes to the same tops, with the same folds.
bool have_same_tops(const SurfaceMaterial& a, const SurfaceMaterial& b) {
  if (!a.shell || !b.shell) return !a.shell && !b.shell;
  const VotfVolume &one = a.shell->volume(), &other = b.shell->volume();
  return one.top == other.top && one.bottom == other.bottom && one.aspect == other.aspect;
}

Bounds bounds_of(const Mesh& mesh, const Affine& to_world) {
  Bounds bounds;
  for (const glm::uvec3& t : mesh.triangles()) {
    for (int k = 0; k < 3; ++k) {
      bounds.add(to_world.point(mesh.positions()[t[k]]));
      for (size_t v = t[k]; v < mesh.moved_positions().size(); v += mesh.positions().size())
        bounds.add(to_world.point(mesh.moved_positions()[v]));
    }
  }
  return bounds;
}

}  // namespace

Bounds Scene::Instance::box_in_world(const Bounds& box) const {
  Bounds bounds = box_around(box, object_to_world);
  for (const Affine& step : steps) bounds.add(box_around(box, step));
  return bounds;
}

void Scene::changed() {
  committed_ = false;
  ++revision_;
}

void Scene::geometry_changed() {
  changed();
  geometry_changed_ = true;
}

uint32_t Scene::add_mesh(Mesh mesh) {
  geometry_changed();
  meshes_.push_back(std::move(mesh));
  return static_cast<uint32_t>(meshes_.size() - 1);
}

void Scene::remove_mesh(uint32_t number) {
  if (number >= meshes_.size()) refuse("Mesh " + std::to_string(number) + " does not exist and cannot be removed.");
  if (std::ranges::any_of(instances_, [&](const Instance& i) { return i.mesh == number; })) {
    refuse("Mesh " + std::to_string(number) + " has instances. Remove them first.");
  }
  geometry_changed();
  meshes_[number] = Mesh(MeshArrays{});
  if (number < mesh_rays_.size()) trace(meshes_[number], false, mesh_rays_[number]);
}

uint32_t Scene::add_material(SurfaceMaterial material) {
  changed();
  materials_.push_back(std::move(material));
  return static_cast<uint32_t>(materials_.size() - 1);
}

void Scene::set_material(uint32_t number, SurfaceMaterial material) {
  if (number >= materials_.size())
    refuse("Material " + std::to_string(number) + " does not exist and cannot be replaced.");
  SurfaceMaterial& place = materials_[number];
  ++revision_;
  if (!have_same_tops(place, material)) geometry_changed();
  if (needs_tangents(material) && !needs_tangents(place)) changed();
  if (material.shell && place.shell) {
    material.shell_tile = place.shell_tile;
    material.shell_softness = place.shell_softness;
  }
  material.gain = place.gain;
  material.hidden_backs = place.hidden_backs;
  place = std::move(material);
}

void Scene::replace_material(uint32_t number) {
  if (materials_.empty() || number >= materials_.size() - 1)
    refuse("Material " + std::to_string(number) + " does not exist and cannot be replaced.");
  if (!have_same_tops(materials_[number], materials_.back())) geometry_changed();
  changed();
  materials_[number] = std::move(materials_.back());
  materials_.pop_back();
}

void Scene::set_gain(uint32_t material, const Rgb& gain) {
  if (material >= materials_.size())
    refuse("Material " + std::to_string(material) + " does not exist and cannot be tinted.");
  for (int c = 0; c < 3; ++c) {
    if (!(gain[c] >= 0 && std::isfinite(gain[c]))) {
      refuse("The gain of a material is " + std::to_string(gain[c]) + "; it must be finite and at least 0.");
    }
  }
  ++revision_;
  materials_[material].gain = gain;
}

void Scene::set_hidden_backs(uint32_t material, uint8_t from) {
  if (material >= materials_.size())
    refuse("Material " + std::to_string(material) + " does not exist; its back faces cannot be hidden.");
  ++revision_;
  materials_[material].hidden_backs = from;
}

void Scene::set_drawn_to(uint32_t material, bool drawn) {
  if (material >= materials_.size())
    refuse("Material " + std::to_string(material) + " does not exist; its emission cannot be sampled.");
  ++revision_;
  materials_[material].drawn_to = drawn;
}

void Scene::add_moving_instance(uint32_t mesh, std::span<const Affine> object_to_world, std::vector<uint32_t> materials,
                                std::vector<TextureMap> placements, uint8_t hidden_from, float terminator) {
  if (mesh >= meshes_.size()) refuse("The instance has mesh " + std::to_string(mesh) + ", which does not exist.");
  require_steps(object_to_world, "an instance");
  if (materials.empty()) refuse("An instance must have at least one material.");
  for (uint32_t m : materials) {
    if (m >= materials_.size()) refuse("The instance has material " + std::to_string(m) + ", which does not exist.");
  }
  require_placements(placements, materials.size());
  geometry_changed();
  std::vector<Affine> steps = motion_steps(object_to_world);
  const Affine middle = steps.empty() ? object_to_world[0] : interpolated(steps, kMiddleTime);
  if (!middle.invertible()) {
    ++flat_instances_;
    return;
  }
  instances_.push_back({mesh, middle, middle.normal_map(), std::move(materials), std::move(placements), hidden_from,
                        std::clamp(terminator, 0.0f, 1.0f)});
  instances_.back().steps = std::move(steps);
}

uint32_t Scene::add_light(const Light& light) {
  require_finite(light.light_to_world, "a light");
  const float numbers[] = {light.color.r, light.color.g, light.color.b, light.size.x,       light.size.y,
                           light.angle,   light.blend,   light.spread,  light.cone_scale.x, light.cone_scale.y};
  for (float x : numbers) {
    if (!std::isfinite(x)) refuse("The color, size, angle or scale of a light is not finite.");
  }
  if (!(light.cone_scale.x > 0.0f) || !(light.cone_scale.y > 0.0f))
    refuse("The cone scale of a spot light must be positive.");
  changed();
  lights_.push_back(light);
  return static_cast<uint32_t>(lights_.size() - 1);
}

void Scene::clear_lights() {
  changed();
  lights_.clear();
}

void Scene::clear_instances() {
  geometry_changed();
  instances_.clear();
  flat_instances_ = 0;
}

void Scene::set_environment(Environment environment) {
  changed();
  environment_ = std::move(environment);
  world_.reset();
}

void Scene::hide_environment(uint8_t from) {
  changed();
  environment_hidden_ = from;
}

void Scene::set_world(WorldProgram world, int width, int height) {
  set_environment(world.baked(width, height));
  world_ = std::move(world);
}

void Scene::look_up_background(const DirectionBatch& world, RgbBatch& radiance) const {
  if (world_) return world_->look_up(world, WorldRays::camera, radiance);
  ScalarBatch unused;
  environment_.look_up(world, radiance, unused);
}

void Scene::set_camera(const Camera& camera) {
  require_rays(camera);
  if (camera.shutter.has_value() != camera_.shutter.has_value()) {  // which decides whether rays meet what moves
    geometry_changed();
    for (uint32_t m = 0; m < meshes_.size(); ++m) {
      if (!meshes_[m].deforms()) continue;
      if (m < mesh_rays_.size()) trace(meshes_[m], false, mesh_rays_[m]);
      drop_tops(m);
    }
  }
  committed_ = false;
  camera_ = camera;
}

void Scene::frame_camera(float aspect, int up_axis) {
  set_camera(Camera::framing(bounds_of_instances(), aspect, up_axis));
}

void Scene::set_working_space(const Mat3& rec709_to_working) {
  changed();
  rec709_to_working_ = rec709_to_working;
  if (rec709_to_working == Mat3(1.0f)) rec709_to_working_.reset();
}

void Scene::commit(int threads, const Progress* progress) {
  if (committed()) return;
  const auto start = std::chrono::steady_clock::now();
  make_tangents();
  if (geometry_changed_) build_rays(threads, progress);
  committed_ = true;
  info_ = count();
  info_.bytes += rays_->bytes() + (sides_ ? sides_->bytes() : 0);
  info_.bvh_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Scene::make_tangents() {
  for (const Instance& i : instances_) {
    Mesh& mesh = meshes_[i.mesh];
    if (mesh.has_tangents() ||
        std::ranges::none_of(i.materials, [&](uint32_t m) { return needs_tangents(materials_[m]); }))
      continue;
    mesh.make_tangents();
    drop_tops(i.mesh);  // they are copies without tangents
  }
}

Bounds Scene::bounds_of_instances() const {
  Bounds bounds;
  for (const Instance& i : instances_) {
    const Mesh& mesh = geometry_changed_ ? meshes_[i.mesh] : traced_mesh(i);
    // Exact bounds matter only for instances at the border, which are few among a hundred thousand.
    if (bounds.holds(i.box_in_world(mesh.bounds()))) continue;
    bounds.add(bounds_of(mesh, i.object_to_world));
    for (const Affine& step : i.steps) bounds.add(bounds_of(mesh, step));
  }
  return bounds;
}

SceneInfo Scene::count() const {
  SceneInfo info;
  info.instances = instances_.size();
  info.meshes = meshes_.size();
  info.lights = lights_.size();
  info.materials = materials_.size();
  info.bytes = environment_.bytes();
  for (const Instance& i : instances_) {
    info.triangles += meshes_[i.mesh].triangles().size();
    info.bytes += 2 * i.steps.size() * sizeof(Affine);  // here and in rays()
  }
  for (const auto& [key, top] : tops_) info.bytes += top.mesh.bytes();
  for (size_t m = 0; m < meshes_.size(); ++m) {
    info.bytes += meshes_[m].bytes();
    if (meshes_[m].dropped() == 0) continue;
    info.warnings.push_back(
        warning<WarningCode::triangles_left_out>({{"mesh", m}, {"triangles", meshes_[m].dropped()}}));
  }
  if (flat_instances_ > 0) {
    info.warnings.push_back(warning<WarningCode::flat_instances_left_out>({{"instances", flat_instances_}}));
  }
  if (unlifted_ > 0) {
    info.warnings.push_back(warning<WarningCode::silhouettes_without_uvs>({{"instances", unlifted_}}));
  }
  const auto append = [&](const std::vector<Warning>& w) {
    info.warnings.insert(info.warnings.end(), w.begin(), w.end());
  };
  append(shell_warnings_);
  for (const Mesh& mesh : meshes_) append(mesh.warnings());
  append(environment_.warnings());
  if (environment_.black() && lights_.empty()) info.warnings.push_back(warning<WarningCode::no_light>());
  return info;
}

uint32_t Scene::slot(const Hit& hit) const {
  const Instance& instance = instances_[hit.instance];
  const uint32_t slot = traced_mesh(instance).material_slot(hit.triangle);
  return std::min<uint32_t>(slot, static_cast<uint32_t>(instance.materials.size() - 1));
}

uint32_t Scene::material(const Hit& hit) const { return instances_[hit.instance].materials[slot(hit)]; }

const TextureMap* Scene::placement(const Hit& hit) const {
  const Instance& instance = instances_[hit.instance];
  return instance.placements.empty() ? nullptr : &instance.placements[slot(hit)];
}

TexturePoint Scene::texture(const Hit& hit, size_t set) const {
  const TexturePoint point = texture_of_mesh(hit, set);
  const TextureMap* placed = set == 0 ? placement(hit) : nullptr;
  if (placed == nullptr) return point;
  const Mat2& map = placed->map;
  return {placed->point(point.uv), map[0].x * point.u_gradient + map[1].x * point.v_gradient,
          map[0].y * point.u_gradient + map[1].y * point.v_gradient};
}

bool Scene::find_dual_edges(const Hit& hit, Vec3d& dual1, Vec3d& dual2) const {
  const Instance& instance = instances_[hit.instance];
  const std::array<Vec3, 3> corner = traced_mesh(instance).corners(hit.triangle, hit.time);
  const Affine map = instance.place(hit.time);
  const Vec3d e1(map.vector(corner[1] - corner[0])), e2(map.vector(corner[2] - corner[0])), normal = glm::cross(e1, e2);
  const double square = glm::dot(normal, normal);
  if (!(square > 0.0)) return false;
  dual1 = glm::cross(e2, normal) / square;
  dual2 = glm::cross(normal, e1) / square;
  return true;
}

Vec2 Scene::barycentric_step(const Hit& hit, const Vec3& offset) const {
  Vec3d dual1, dual2;
  if (!find_dual_edges(hit, dual1, dual2)) return Vec2(0.0f);
  return Vec2(glm::dot(dual1, Vec3d(offset)), glm::dot(dual2, Vec3d(offset)));
}

TexturePoint Scene::texture_of_mesh(const Hit& hit, size_t set) const {
  const Mesh& mesh = traced_mesh(instances_[hit.instance]);
  if (!mesh.has_uvs()) return {};
  const std::span<const Vec2, 3> uv = mesh.corner_uvs(hit.triangle, set);
  // The dot products of the gradients with the edges are uv[k] - uv[0], so they are sums of the edges' dual vectors.
  Vec3d dual1, dual2;
  if (!find_dual_edges(hit, dual1, dual2)) return {};
  const Vec2 d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
  const auto gradient = [&](int i) {
    return Vec3(static_cast<double>(d1[i]) * dual1 + static_cast<double>(d2[i]) * dual2);
  };
  const TexturePoint point{uv[0] + hit.u * d1 + hit.v * d2, gradient(0), gradient(1)};
  const float sum = glm::dot(point.uv, Vec2(1.0f)) + glm::dot(point.u_gradient + point.v_gradient, Vec3(1.0f));
  return std::isfinite(sum) ? point : TexturePoint{};
}

Mat3 Scene::relief(const Hit& hit) const {
  const Instance& instance = instances_[hit.instance];
  const Mesh& mesh = traced_mesh(instance);
  if (!mesh.has_tangents()) return Mat3(0.0f);
  return instance.normal_map(hit.time) * mesh.relief(hit.triangle, {hit.u, hit.v}, hit.time);
}

Vec3 Scene::tangent(const Hit& hit) const {
  const Mesh& mesh = traced_mesh(instances_[hit.instance]);
  const TextureMap* placed = placement(hit);
  const Mat2 map = placed != nullptr ? placed->map : Mat2(1.0f);
  const bool smooth = mesh.has_tangents() && materials_[material(hit)].brushed;
  return smooth ? mesh.smooth_tangent(hit.triangle, {hit.u, hit.v}, map, hit.time)
                : mesh.tangent(hit.triangle, map, hit.time);
}

SurfacePoint Scene::surface(const Hit& hit) const {
  const Instance& instance = instances_[hit.instance];
  const Mesh& mesh = traced_mesh(instance);
  const Vec2 uv(hit.u, hit.v);
  const Vec3 local = mesh.position(hit.triangle, uv, hit.time);
  const Affine map = instance.place(hit.time);
  SurfacePoint point;
  point.position = map.point(local);
  const Vec3& front = hit.geometric_normal;
  point.geometric_normal =
      glm::normalize(front / std::max({std::abs(front.x), std::abs(front.y), std::abs(front.z), 1e-37f}));
  const Vec3 normal = mesh.shading_normal(hit.triangle, uv, hit.time);
  point.shading_normal = glm::normalize((instance.moves() ? map.normal_map() : instance.normal_to_world) * normal);
  point.tangent = map.vector(tangent(hit));
  const bool moves = instance.moves() || mesh.deforms();
  point.error = position_error(map, mesh.position_magnitude(hit.triangle, uv, hit.time), moves);
  point.material = material(hit);
  if (instance.terminator > 0.0f) {
    point.rounding = rounding(instance, hit);
    if (point.rounding != Vec3(0.0f)) point.terminator = instance.terminator;
  }
  return point;
}

/// Offset to a paraboloid through the triangle's corners, from their normals, as in Cycles (shadow_ray_offset; after
/// Hanika 2021, "Hacking the Shadow Terminator"). Zero where the surface is concave: rays must not begin below it.
Vec3 Scene::rounding(const Instance& instance, const Hit& hit) const {
  const Mesh& mesh = traced_mesh(instance);
  const Affine map = instance.place(hit.time);
  const Mat3 normal_map = instance.normal_map(hit.time);
  std::array<Vec3, 3> p = mesh.corners(hit.triangle, hit.time), n = mesh.corner_normals(hit.triangle, hit.time);
  for (Vec3& corner : p) corner = map.point(corner);
  for (Vec3& normal : n) normal = glm::normalize(normal_map * normal);
  const float u = 1.0f - hit.u - hit.v, v = hit.u;  // weights of corners 0 and 1
  const float a = glm::dot(n[2] - n[0], p[0] - p[2]), b = glm::dot(n[2] - n[1], p[1] - p[2]);
  const float c = glm::dot(n[1] - n[0], p[1] - p[0]);
  const float height = a * u * (u - 1) + (a + b + c) * u * v + b * v * (v - 1);
  if (!(height > 0.0f) || !std::isfinite(height)) return Vec3(0.0f);
  return height * (u * n[0] + v * n[1] + hit.v * n[2]);
}

}  // namespace velour

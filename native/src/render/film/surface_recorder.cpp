#include "render/film/surface_recorder.h"

#include <algorithm>
#include <cmath>
#include "render/continuation.h"

namespace velour {

namespace {

template <typename Label>
Label label_of(const std::vector<Label>& labels, size_t number) {
  return number < labels.size() ? labels[number] : Label{};
}

}  // namespace

SurfaceSample SurfaceRecorder::record(const PassOptions& options, const Vertex& vertex, const Hit& hit,
                                      const Rgb& throughput, const PathNumbers& numbers) {
  const auto material = static_cast<size_t>(vertex.surface - scene_.materials().data());
  const InstanceLabel of_instance = label_of(options.instances, hit.instance);
  const MaterialLabel of_material = label_of(options.materials, material);
  SurfaceSample s;
  s.position = vertex.position;
  s.object_index = of_instance.index;
  s.material_index = of_material.index;
  s.seen = std::min((throughput.r + throughput.g + throughput.b) / 3.0f, 1.0f);
  s.object_id = of_instance.object_id;
  s.asset_id = of_instance.asset_id;
  s.material_id = of_material.id;
  if (options.has(pass::kUv)) s.uv = uv(hit, of_instance.uv_set);
  if (options.has(pass::kMist)) s.clear = (1.0f - options.mist.at(distance(vertex.position))) * s.seen;
  if (options.has(pass::kAlbedo | pass::kDenoisingAlbedo | pass::kHalves))
    s.albedo = throughput * albedo_.estimate(vertex, numbers);
  if (options.has(pass::kDenoisingAlbedo | pass::kHalves)) s.shine = throughput * vertex.emission();
  if (options.has(pass::kVector)) find_motion(hit, s);
  return s;
}

void SurfaceRecorder::find_motion(const Hit& hit, SurfaceSample& sample) const {
  const Hit at = scene_.has_shell(hit) ? scene_.shell_foot(hit).top : hit;
  const Vec2 here = current_.picture(scene_.position(at, kMiddleTime));
  const Vec2 before = size_ * (previous_.picture(scene_.position(at, 0.0f)) - here);
  const Vec2 after = size_ * (here - next_.picture(scene_.position(at, 1.0f)));
  if (!std::isfinite(before.x + before.y + after.x + after.y)) return;  // behind the camera
  sample.from_previous = before;
  sample.to_next = after;
  sample.surfaces = 1;
}

Vec3 SurfaceRecorder::uv(const Hit& hit, int set) const {
  const Hit at = scene_.has_shell(hit) ? scene_.shell_foot(hit).top : hit;
  const Mesh& mesh = scene_.traced_mesh(scene_.instances()[at.instance]);
  if (set < 0 || !mesh.has_uvs()) return Vec3(0.0f);
  const auto corner = mesh.corner_uvs(at.triangle, static_cast<size_t>(set));
  return {(1.0f - at.u - at.v) * corner[0] + at.u * corner[1] + at.v * corner[2], 1.0f};
}

/// Distance for mist, as in Cycles: from the camera, or from its plane if it is orthographic.
float SurfaceRecorder::distance(const Vec3& world) const {
  const Camera& camera = scene_.camera();
  if (camera.type == Camera::Type::orthographic) return std::abs(camera.depth(world));
  return glm::distance(world, camera.camera_to_world.column(3));
}

Rgb SurfaceAlbedo::estimate(const Vertex& vertex, PathNumbers numbers) {
  arena_.reset();
  const PreparedBrdf* const brdf = vertex.surface->material->prepare(vertex.wv, vertex.site, {}, arena_);
  Vec2 u[kDirections];
  numbers.points(Purpose::surface, numbers.ray() * kDirections, u);
  brdf->sample(u, drawn_);
  wl_.count = 0;
  for (int i = 0; i < drawn_.count; ++i) {
    const Vec3 wl = drawn_.get(i);
    if (vertex.receives(wl, vertex.frame.to_world(wl))) wl_.push(wl);
  }
  if (wl_.count == 0) return Rgb(0.0f);
  wl_.pad();
  brdf->eval(wl_, f_, pdf_);
  Rgb sum(0.0f);
  for (int i = 0; i < wl_.count; ++i) {
    const Rgb term = f_.get(i) * (std::abs(wl_.z[i]) / pdf_.v[i]);
    if (std::isfinite(term.r + term.g + term.b)) sum += term;
  }
  return in_working_space(rec709_to_working_, vertex, sum / static_cast<float>(kDirections));
}

}  // namespace velour

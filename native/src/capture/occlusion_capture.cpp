#include "capture/occlusion_capture.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "capture/reference_plane.h"
#include "capture/shell_columns.h"
#include "capture/shell_grid.h"
#include "capture/surface_distance.h"
#include "capture/tile_checks.h"
#include "capture/traced_mask.h"
#include "job/threads.h"
#include "material/material.h"

namespace velour {
namespace {

constexpr float kSheet = 0.6f;  // half thickness of sheets in pitches, enough for look-ups between points to find them

/// Triangles of the tile in its own coordinates, in widths.
std::vector<Triangle> triangles_of(const RepeatedTile& tile, double surface) {
  const float scale = 1 / tile.period().x;
  const Vec3 origin(tile.place().origin, static_cast<float>(surface));
  std::vector<Triangle> triangles;
  for (const Scene::Instance& instance : tile.scene().instances()) {
    const Mesh& mesh = tile.scene().traced_mesh(instance);
    for (const glm::uvec3& t : mesh.triangles()) {
      Triangle triangle;
      for (int k = 0; k < 3; ++k) {
        triangle.corner[k] = scale * (instance.object_to_world.point(mesh.positions()[t[k]]) - origin);
      }
      triangles.push_back(triangle);
    }
  }
  return triangles;
}

class OcclusionCapturer {
 public:
  OcclusionCapturer(const Scene& scene, const OcclusionCaptureOptions& options, Progress& progress)
      : options_(options),
        progress_(progress),
        tile_(scene, place_of(scene, options.place), options.threads, progress) {}

  OcclusionCapture run() {
    const auto start = std::chrono::steady_clock::now();
    inspect();
    measure();
    progress_.stage("computing distances", 0.1, 0.6);
    fill();
    result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    progress_.stage("checking the silhouette", 0.6, 1);
    if (options_.check_views > 0) result_.errors = errors();
    result_.ray_share = share_.measure(tile_.rays(), progress_);
    return std::move(result_);
  }

 private:
  OcclusionVolume& volume() { return result_.volume; }
  float in_widths(double z) const { return static_cast<float>((z - options_.surface) / tile_.period().x); }

  void inspect() {
    volume().closed = !is_open(tile_);
    if (const auto warning = seam_warning(tile_)) result_.warnings.push_back(*warning);
    const auto& materials = tile_.scene().materials();
    if (!std::ranges::all_of(materials, [](const SurfaceMaterial& m) { return m.material->opaque(); })) {
      result_.warnings.emplace_back(
          "A material of the tile is transparent (alpha). The silhouette (VOTF) treats its surface as opaque.");
    }
  }

  void measure() {
    OcclusionVolume& v = volume();
    const bool closed = v.closed;
    v = empty_shell(options_.texels, tile_.period().y / tile_.period().x,
                    in_widths(static_cast<double>(tile_.bottom())), in_widths(static_cast<double>(tile_.top())));
    v.closed = closed;
    v.tile_width = static_cast<float>(options_.metres_per_unit) * tile_.period().x;
    progress_.stage("finding the reference plane", 0, 0.1);
    const double reference = options_.reference_height
                                 ? *options_.reference_height
                                 : static_cast<double>(least_variance_height(tile_, !v.closed, progress_));
    v.reference = in_widths(reference);
  }

  TileTexels texels() const { return {result_.volume.width, result_.volume.height, result_.volume.aspect}; }

  void fill() {
    OcclusionVolume& v = volume();
    const std::vector<float> distance = surface_distances(triangles_of(tile_, options_.surface), grid_of(v), progress_);
    progress_.update(0.7);
    std::vector<Vec2> places;
    for (size_t i = 0; i < texels().size(); ++i) places.push_back(tile_.period().x * texels().centre(i));
    const ShellColumns columns(tile_, places, 0.5f * v.pitch() * tile_.period().x, v.closed, share_);
    const bool sheets = !v.closed && columns.unclosed() > 0;
    if (sheets) {
      result_.warnings.push_back(std::to_string(columns.unclosed()) + " of " + std::to_string(places.size()) +
                                 " vertical lines meet a sheet without thickness, which was made about one texel "
                                 "thick. Give it a thickness, or increase the number of texels.");
    }
    const float thicker = sheets ? kSheet * v.pitch() : 0.0f;
    v.distance.resize(distance.size());
    tbb::parallel_for(0u, v.depth, [&](uint32_t z) {
      const float height =
          (v.bottom + static_cast<float>(z) * v.step()) * tile_.period().x + static_cast<float>(options_.surface);
      for (size_t i = 0; i < places.size(); ++i) {
        const size_t at = z * places.size() + i;
        const float signed_distance = columns.inside(i, height) ? -distance[at] : distance[at];
        v.distance[at] = distance_byte((signed_distance - thicker) / v.reach);
      }
    });
  }

  OcclusionErrors errors() {
    // Non-owning pointer: the volume outlives `field`.
    const ShellField field(std::shared_ptr<const OcclusionVolume>(std::shared_ptr<void>(), &volume()));
    const float reference = volume().reference * tile_.period().x + static_cast<float>(options_.surface);
    std::vector<std::pair<int64_t, int64_t>> seen(options_.check_views);  // numbers of covered and of wrong texels
    tbb::parallel_for(0u, options_.check_views, [&](uint32_t i) {
      progress_.check();
      const Vec3 wv = check_view(options_.seed, i);
      std::vector<uint8_t> truth;
      share_.record(i, {0, 0, static_cast<int>(texels().width), static_cast<int>(texels().height)}, 1,
                    [&](RayLog* log) { truth = traced_mask(tile_, texels(), reference, wv, log); });
      const auto found = visibility_mask(field, texels(), wv);
      seen[i].first = std::ranges::count(truth, 1);
      for (size_t t = 0; t < truth.size(); ++t) seen[i].second += truth[t] != found[t] ? 1 : 0;
    });
    const double all = static_cast<double>(options_.check_views) * static_cast<double>(texels().size());
    OcclusionErrors errors;
    for (const auto& [covered, wrong] : seen) {
      errors.coverage += static_cast<double>(covered) / all;
      errors.wrong += static_cast<double>(wrong) / all;
    }
    return errors;
  }

  const OcclusionCaptureOptions& options_;
  Progress& progress_;
  const RepeatedTile tile_;
  RayShare share_{options_.measure_ray_share, 8};
  OcclusionCapture result_;
};

}  // namespace

OcclusionCapture capture_occlusion(const Scene& scene, const OcclusionCaptureOptions& options, Progress& progress) {
  OcclusionCapture capture;
  tbb::task_arena arena(arena_concurrency(options.threads));
  arena.execute([&] { capture = OcclusionCapturer(scene, options, progress).run(); });
  return capture;
}

}  // namespace velour

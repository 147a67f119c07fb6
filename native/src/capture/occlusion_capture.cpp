#include "capture/occlusion_capture.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "capture/reference_plane.h"
#include "capture/shell_columns.h"
#include "capture/surface_distance.h"
#include "capture/tile_checks.h"
#include "job/threads.h"
#include "material/material.h"
#include "sphere/random.h"
#include "votf/shell_trace.h"

namespace velour {
namespace {

constexpr float kReach = 8;     // of distances, pitches
constexpr float kSheet = 0.6f;  // half the thickness of a sheet, pitches: a look-up between points finds it
constexpr uint32_t kLeastTexels = 4;

[[noreturn]] void refuse(const std::string& sentence) { throw Error(Status::invalid_argument, sentence); }

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

class Capture {
 public:
  Capture(const Scene& scene, const OcclusionCaptureOptions& options, Progress& progress)
      : options_(options),
        progress_(progress),
        tile_(scene, place_of(scene, options.place), options.threads, progress) {}

  OcclusionCapture run() {
    const auto start = std::chrono::steady_clock::now();
    inspect();
    measure();
    progress_.stage("distances", 0.1, 0.6);
    fill();
    result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    progress_.stage("checking", 0.6, 1);
    if (options_.check_views > 0) result_.errors = errors();
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
      result_.warnings.push_back("A material of the tile lets rays through (alpha); its surface counts as solid.");
    }
  }

  void measure() {
    OcclusionVolume& v = volume();
    v.width = options_.texels;
    v.aspect = tile_.period().y / tile_.period().x;
    v.height = std::max(1u, static_cast<uint32_t>(std::lround(static_cast<float>(v.width) * v.aspect)));
    // A point beyond the structure at both ends: a ray begins and ends outside.
    v.bottom = in_widths(static_cast<double>(tile_.bottom())) - v.pitch();
    v.top = in_widths(static_cast<double>(tile_.top())) + v.pitch();
    const double cells = std::ceil(static_cast<double>((v.top - v.bottom) / v.pitch()));
    if (v.height > OcclusionVolume::kMaxSide || cells + 1 > OcclusionVolume::kMaxDepth ||
        uint64_t{v.width} * v.height * static_cast<uint64_t>(cells + 1) > OcclusionVolume::kMaxPoints) {
      refuse("A shell of " + std::to_string(v.width) + " x " + std::to_string(v.height) + " x " +
             std::to_string(static_cast<uint64_t>(cells) + 1) + " points is too large; give fewer texels.");
    }
    v.depth = static_cast<uint32_t>(cells) + 1;
    v.reach = kReach * v.pitch();
    v.tile_width = static_cast<float>(options_.metres_per_unit) * tile_.period().x;
    progress_.stage("reference plane", 0, 0.1);
    const double reference = options_.reference_height
                                 ? *options_.reference_height
                                 : static_cast<double>(least_variance_height(tile_, !v.closed, progress_));
    v.reference = in_widths(reference);
  }

  Vec2 place(uint32_t x, uint32_t y) const {
    const OcclusionVolume& v = result_.volume;
    return {(static_cast<float>(x) + 0.5f) / static_cast<float>(v.width),
            (static_cast<float>(y) + 0.5f) / static_cast<float>(v.height) * v.aspect};
  }

  void fill() {
    OcclusionVolume& v = volume();
    const DistanceGrid grid{v.width,
                            v.height,
                            v.depth,
                            Vec3(place(0, 0), v.bottom),
                            {v.pitch(), v.aspect / static_cast<float>(v.height), v.step()}};
    const std::vector<float> distance = surface_distances(triangles_of(tile_, options_.surface), grid, progress_);
    progress_.update(0.7);
    std::vector<Vec2> places;
    for (uint32_t y = 0; y < v.height; ++y) {
      for (uint32_t x = 0; x < v.width; ++x) places.push_back(tile_.period().x * place(x, y));
    }
    const ShellColumns columns(tile_, places, 0.5f * v.pitch() * tile_.period().x, v.closed);
    const bool sheets = !v.closed && columns.unclosed() > 0;
    if (sheets) {
      result_.warnings.push_back(std::to_string(columns.unclosed()) + " of " + std::to_string(places.size()) +
                                 " vertical lines meet a sheet that has no inside; it becomes about a texel thick.");
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

  /// Rays through all texel centres at the reference plane, under one view.
  struct Seen {
    uint64_t blocked = 0, wrong = 0;
  };
  Seen compare(const ShellField& field, const Vec3& wv) const {
    const OcclusionVolume& v = result_.volume;
    const Vec3 up = wv / wv.z;
    const float reference = v.reference * tile_.period().x + static_cast<float>(options_.surface);
    TileRays rays(tile_);
    std::vector<Ray> row(v.width);
    std::vector<Hit> hits(v.width);
    Seen seen;
    for (uint32_t y = 0; y < v.height; ++y) {
      for (uint32_t x = 0; x < v.width; ++x) {
        const Vec2 from = tile_.period().x * place(x, y) + Vec2(up) * (tile_.top() - reference);
        row[x] = {Vec3(tile_.into_cell(from), tile_.top() + 1e-4f * tile_.period().x), 0, -wv};
      }
      rays.intersect(row, hits, nullptr);
      for (uint32_t x = 0; x < v.width; ++x) {
        const bool blocked = hits[x].instance != kNoHit;
        seen.blocked += blocked ? 1 : 0;
        seen.wrong += blocked != line_meets(field, place(x, y), wv) ? 1 : 0;
      }
    }
    return seen;
  }

  OcclusionErrors errors() {
    // Shares the volume, which stays where it is.
    const ShellField field(std::shared_ptr<const OcclusionVolume>(std::shared_ptr<void>(), &volume()));
    std::vector<Seen> seen(options_.check_views);
    tbb::parallel_for(0u, options_.check_views, [&](uint32_t i) {
      progress_.check();
      RandomStream numbers(options_.seed, i, 0);
      const float cosine = 1 - numbers.next() * (1 - std::cos(radians_from(75.0f)));
      seen[i] = compare(field, direction(std::acos(cosine), 2 * kPi * numbers.next()));
    });
    const double all = static_cast<double>(options_.check_views) * volume().width * volume().height;
    OcclusionErrors errors;
    for (const Seen& s : seen) {
      errors.coverage += static_cast<double>(s.blocked) / all;
      errors.wrong += static_cast<double>(s.wrong) / all;
    }
    return errors;
  }

  const OcclusionCaptureOptions& options_;
  Progress& progress_;
  const RepeatedTile tile_;
  OcclusionCapture result_;
};

}  // namespace

OcclusionCapture capture_occlusion(const Scene& scene, const OcclusionCaptureOptions& options, Progress& progress) {
  if (options.texels < kLeastTexels || options.texels > OcclusionVolume::kMaxSide) {
    refuse("A shell cannot have " + std::to_string(options.texels) + " texels along x; it takes " +
           std::to_string(kLeastTexels) + " to " + std::to_string(OcclusionVolume::kMaxSide) + ".");
  }
  OcclusionCapture capture;
  tbb::task_arena arena(arena_concurrency(options.threads));
  arena.execute([&] { capture = Capture(scene, options, progress).run(); });
  return capture;
}

}  // namespace velour

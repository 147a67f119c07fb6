#include "votf/capture/votf_capture.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>
#include <vector>
#include "base/parallel.h"
#include "capture/btf/repeated_tile.h"
#include "capture/btf/tile_checks.h"
#include "material/material.h"
#include "render/ray_log.h"
#include "votf/capture/data_votf.h"
#include "votf/capture/surface_distance.h"

namespace velour {

namespace {

/// Counts how often vertical lines from above have entered the structure without leaving it, by the facing of the
/// surfaces they hit.
class ShellColumns {
 public:
  /// Follows lines through `places` (local coordinates). A line must end outside the structure if the tile is open, and
  /// inside if it is closed; a line that does not is retried a little to the side, by at most about `aside`.
  ShellColumns(const RepeatedTile& tile, const std::vector<Vec2>& places, float aside, bool closed, RayShare& share,
               const Progress& progress);

  /// Whether `height` on a line is inside. A line of an open tile that never leaves the structure has hit a sheet,
  /// which has no inside.
  bool inside(size_t line, float height) const;
  /// Number of lines that ended wrongly in all tries.
  size_t unclosed() const { return unclosed_; }

 private:
  struct Crossing {
    float height;
    int depth;  // below the crossing
  };
  using Line = std::vector<Crossing>;
  /// Follows adjacent lines together, with a batch of rays for each crossing.
  void follow(std::span<const Vec2> places, float aside, std::span<Line> lines, RayLog* log) const;
  std::vector<Line> followed(TileRays& rays, std::span<const Vec2> places, RayLog* log) const;
  bool ends_well(const Line& line) const;

  const RepeatedTile& tile_;
  const bool closed_;
  std::vector<Line> lines_;
  size_t unclosed_ = 0;
};

constexpr size_t kMaxCrossings = 1024, kBlock = 256;

/// Offsets of the tries, in units of `aside`.
constexpr std::array<Vec2, 5> kTries = {Vec2(0, 0), Vec2(0.37f, 0.61f), Vec2(-0.71f, 0.23f), Vec2(0.53f, -0.89f),
                                        Vec2(-0.97f, -0.47f)};

ShellColumns::ShellColumns(const RepeatedTile& tile, const std::vector<Vec2>& places, float aside, bool closed,
                           RayShare& share, const Progress& progress)
    : tile_(tile), closed_(closed), lines_(places.size()) {
  tbb::parallel_for(size_t{0}, (places.size() + kBlock - 1) / kBlock, [&](size_t block) {
    progress.check();
    const size_t first = block * kBlock, count = std::min(kBlock, places.size() - first);
    share.record(block, {0, 0, static_cast<int>(count), 1}, 1, [&](RayLog* log) {
      follow(std::span(places).subspan(first, count), aside, std::span(lines_).subspan(first, count), log);
    });
  });
  unclosed_ = static_cast<size_t>(std::ranges::count_if(lines_, [&](const Line& line) { return !ends_well(line); }));
}

void ShellColumns::follow(std::span<const Vec2> places, float aside, std::span<Line> lines, RayLog* log) const {
  TileRays rays(tile_);
  std::vector<size_t> tried(places.size());
  std::iota(tried.begin(), tried.end(), size_t{0});
  for (const Vec2& shift : kTries) {
    std::vector<Vec2> shifted;
    for (const size_t i : tried) shifted.push_back(tile_.into_cell(places[i] + aside * shift));
    std::vector<Line> found = followed(rays, shifted, log);
    std::vector<size_t> again;
    for (size_t k = 0; k < tried.size(); ++k) {
      const bool good = ends_well(found[k]);
      if (!good) again.push_back(tried[k]);
      if (good || &shift == &kTries.front()) lines[tried[k]] = std::move(found[k]);
    }
    if (again.empty()) return;
    tried = std::move(again);
  }
}

std::vector<ShellColumns::Line> ShellColumns::followed(TileRays& tracer, std::span<const Vec2> places,
                                                       RayLog* log) const {
  const float margin = 1e-3f * (tile_.thickness() + tile_.period().x);
  // Clear of the face just met, also where the tile lies far from the plane z = 0.
  const float rounding =
      1e-6f * std::max({tile_.thickness() + margin, std::abs(tile_.bottom()), std::abs(tile_.top())});
  std::vector<Line> lines(places.size());
  std::vector<Ray> rays;
  std::vector<size_t> line_of;
  for (size_t i = 0; i < places.size(); ++i) {
    rays.push_back({Vec3(places[i], tile_.top() + margin), 0, {0, 0, -1}});
    line_of.push_back(i);
  }
  std::vector<Hit> hits(rays.size());
  while (!rays.empty()) {
    tracer.intersect(rays, std::span(hits).first(rays.size()), log);
    size_t left = 0;
    for (size_t k = 0; k < rays.size(); ++k) {
      Line& line = lines[line_of[k]];
      if (hits[k].instance == kNoHit || line.size() == kMaxCrossings) continue;
      const float height = rays[k].origin.z - hits[k].distance;
      const int above = line.empty() ? 0 : line.back().depth;
      line.push_back({height, above + (hits[k].geometric_normal.z > 0 ? 1 : -1)});
      line_of[left] = line_of[k];
      rays[left++] = {Vec3(places[line_of[k]], height - rounding), 0, {0, 0, -1}};
    }
    rays.resize(left);
  }
  return lines;
}

bool ShellColumns::ends_well(const Line& line) const {
  const int depth = line.empty() ? 0 : line.back().depth;
  return closed_ ? depth != 0 : depth == 0;
}

bool ShellColumns::inside(size_t line, float height) const {
  const Line& crossings = lines_[line];
  const auto below = std::ranges::find_if(crossings, [&](const Crossing& c) { return c.height < height; });
  const int depth = below == crossings.begin() ? 0 : std::prev(below)->depth;
  const int never_left = closed_ || crossings.empty() ? 0 : std::abs(crossings.back().depth);
  return std::abs(depth) > never_left;  // below 0 within faces whose normals point inwards
}

constexpr double kMaxWrong = 0.1;  // beyond it, faces must be turned the wrong way
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

class VotfCapturer {
 public:
  VotfCapturer(const Scene& scene, const VotfCaptureOptions& options, Progress& progress)
      : options_(options),
        progress_(progress),
        tile_(scene, place_of(scene, options.place), options.threads, progress) {}

  VotfCapture run() {
    const auto start = std::chrono::steady_clock::now();
    inspect();
    measure();
    progress_.stage("computing distances", 0.1, 0.6);
    fill();
    result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    progress_.stage("checking the silhouette", 0.6, 1);
    if (options_.check_views > 0) result_.errors = errors();
    if (result_.errors && result_.errors->wrong > kMaxWrong) {
      result_.warnings.push_back(warning<WarningCode::silhouette_differs>({{"wrong", result_.errors->wrong}}));
    }
    result_.ray_share = share_.measure(tile_.rays(), progress_);
    return std::move(result_);
  }

 private:
  VotfVolume& volume() { return result_.volume; }
  float in_widths(double z) const { return static_cast<float>((z - options_.surface) / tile_.period().x); }

  void inspect() {
    volume().closed = !is_open(tile_);
    if (const auto seam = seam_warning(tile_)) result_.warnings.push_back(*seam);
    const auto& materials = tile_.scene().materials();
    if (!std::ranges::all_of(materials, [](const SurfaceMaterial& m) { return m.material->opaque(); })) {
      result_.warnings.push_back(warning<WarningCode::tile_is_transparent>());
    }
  }

  void measure() {
    VotfVolume& v = volume();
    const bool closed = v.closed;
    v = empty_shell(options_.texels, tile_.period().y / tile_.period().x,
                    in_widths(static_cast<double>(tile_.bottom())), in_widths(static_cast<double>(tile_.top())));
    v.closed = closed;
    v.tile_width = static_cast<float>(options_.metres_per_unit) * tile_.period().x;
    progress_.stage("finding the reference plane", 0, 0.1);
    const bool two_sided = options_.two_sided.value_or(!v.closed);
    v.reference =
        in_widths(options_.reference_height ? *options_.reference_height
                                            : static_cast<double>(least_variance_height(tile_, two_sided, progress_)));
  }

  TileTexels texels() const { return {result_.volume.width, result_.volume.height, result_.volume.aspect}; }

  void fill() {
    VotfVolume& v = volume();
    const std::vector<float> distance = surface_distances(triangles_of(tile_, options_.surface), grid_of(v), progress_);
    progress_.update(0.7);
    std::vector<Vec2> places;
    for (size_t i = 0; i < texels().size(); ++i) places.push_back(tile_.period().x * texels().center(i));
    const ShellColumns columns(tile_, places, 0.5f * v.pitch() * tile_.period().x, v.closed, share_, progress_);
    const bool sheets = !v.closed && columns.unclosed() > 0;
    if (sheets) {
      result_.warnings.push_back(
          warning<WarningCode::sheets_thickened>({{"lines", columns.unclosed()}, {"sampled", places.size()}}));
    }
    const float thicker = sheets ? kSheet * v.pitch() : 0.0f;
    v.distance.resize(distance.size());
    tbb::parallel_for(0u, v.depth, [&](uint32_t z) {
      progress_.check();
      const float height =
          (v.bottom + static_cast<float>(z) * v.step()) * tile_.period().x + static_cast<float>(options_.surface);
      for (size_t i = 0; i < places.size(); ++i) {
        const size_t at = z * places.size() + i;
        const float signed_distance = columns.inside(i, height) ? -distance[at] : distance[at];
        v.distance[at] = distance_byte((signed_distance - thicker) / v.reach);
      }
    });
  }

  VotfErrors errors() {
    // Non-owning pointer: the volume outlives `field`.
    const ShellField field(std::shared_ptr<const VotfVolume>(std::shared_ptr<void>(), &volume()));
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
    VotfErrors errors;
    for (const auto& [covered, wrong] : seen) {
      errors.coverage += static_cast<double>(covered) / all;
      errors.wrong += static_cast<double>(wrong) / all;
    }
    return errors;
  }

  const VotfCaptureOptions& options_;
  Progress& progress_;
  const RepeatedTile tile_;
  RayShare share_{options_.measure_ray_share, 8};
  VotfCapture result_;
};

}  // namespace

VotfCapture capture_votf(const Scene& scene, const VotfCaptureOptions& options, Progress& progress) {
  VotfCapture capture;
  tbb::task_arena arena(arena_concurrency(options.threads));
  arena.execute([&] { capture = VotfCapturer(scene, options, progress).run(); });
  return capture;
}

std::vector<uint8_t> traced_mask(const RepeatedTile& tile, const TileTexels& texels, float reference, const Vec3& wv,
                                 RayLog* log) {
  const Vec2 aside = Vec2(wv) / wv.z * (tile.top() - reference);
  const float above = tile.top() + 1e-4f * tile.period().x;
  TileRays rays(tile);
  std::vector<Ray> row(texels.width);
  std::vector<Hit> hits(texels.width);
  std::vector<uint8_t> mask;
  for (uint32_t y = 0; y < texels.height; ++y) {
    for (uint32_t x = 0; x < texels.width; ++x) {
      row[x] = {Vec3(tile.into_cell(tile.period().x * texels.center(x, y) + aside), above), 0, -wv};
    }
    rays.intersect(row, hits, log);
    for (const Hit& hit : hits) mask.push_back(hit.instance != kNoHit ? 1 : 0);
  }
  return mask;
}

}  // namespace velour

#include "votf/capture/data_votf.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string>

#include "base/error.h"
#include "base/parallel.h"
#include "btf/model/srbf_btf.h"
#include "votf/eval/occlusion_volume.h"
#include "votf/eval/shell_trace.h"

namespace velour {

namespace {

constexpr float kBand = 2;       // pitches behind the surface seen by a view within which the view counts
constexpr float kWhole = 0.98f;  // minimum coverage for a texel's mean height to be that of a surface
constexpr float kSmooth = 1;     // maximum spread in pitches, and half the maximum step; more is an edge

VotfVolume without_distances(const VotfVolume& volume) {
  VotfVolume sizes = volume;
  sizes.distance.clear();
  return sizes;
}

/// Inserts `number` into a descending list and drops the last element.
void insert(float number, std::span<float> falling) {
  for (float& f : falling) {
    if (number > f) std::swap(number, f);
  }
}

}  // namespace

/// The texels of a view whose heights are those of a surface rather than an edge.
struct ShellFusion::Surfaces {
  std::vector<float> weight;  // 0: an edge
  std::vector<float> slant;   // pitches of perpendicular distance per width of height

  Surfaces(const SeenTexels& seen, const TileTexels& texels, float pitch);
};

ShellFusion::Surfaces::Surfaces(const SeenTexels& seen, const TileTexels& texels, float pitch) {
  if (seen.height.empty()) return;
  weight.assign(texels.size(), 0.0f);
  slant.assign(texels.size(), 0.0f);
  const float most = kSmooth * pitch;
  const auto whole = [&](size_t t) { return seen.coverage[t] >= kWhole && seen.spread[t] <= most; };
  const Vec3 along = seen.wv / seen.wv.z;
  for (uint32_t y = 0; y < texels.height; ++y) {
    for (uint32_t x = 0; x < texels.width; ++x) {
      const size_t t = size_t{y} * texels.width + x;
      if (!whole(t)) continue;
      // Uses the neighbor along each axis with the smaller step in height.
      const auto step = [&](size_t a, size_t b, const Vec3& onwards) {
        const bool first = std::abs(seen.height[a] - seen.height[t]) < std::abs(seen.height[b] - seen.height[t]);
        const float rise = first ? seen.height[a] - seen.height[t] : seen.height[t] - seen.height[b];
        return onwards + rise * along;
      };
      const size_t row = size_t{y} * texels.width;
      const size_t right = row + (x + 1) % texels.width, left = row + (x + texels.width - 1) % texels.width;
      const size_t above = size_t{(y + 1) % texels.height} * texels.width + x;
      const size_t below = size_t{(y + texels.height - 1) % texels.height} * texels.width + x;
      const Vec3 normal =
          glm::normalize(glm::cross(step(right, left, {1 / static_cast<float>(texels.width), 0, 0}),
                                    step(above, below, {0, texels.aspect / static_cast<float>(texels.height), 0})));
      const float cosine = std::max(std::abs(glm::dot(normal, seen.wv)), 0.05f);
      weight[t] = cosine / (1 + seen.spread[t] * seen.spread[t] / (most * most));
      slant[t] = cosine / (std::abs(seen.wv.z) * pitch);
    }
  }
}

ShellFusion::ShellFusion(const VotfVolume& volume, const TileTexels& texels, bool closed)
    : grid_(without_distances(volume)),
      texels_(texels),
      closed_(closed),
      evidence_(size_t{grid_.width} * grid_.height * grid_.depth) {}

void ShellFusion::add(const SeenTexels& seen, const Progress& progress) {
  ++views_;
  const Surfaces surfaces(seen, texels_, grid_.pitch());
  tbb::parallel_for(0u, grid_.depth, [&](uint32_t z) {
    progress.check();
    add_layer(seen, surfaces, z);
  });
}

void ShellFusion::add_layer(const SeenTexels& seen, const Surfaces& surfaces, uint32_t z) {
  const float height = grid_.bottom + static_cast<float>(z) * grid_.step();
  const Vec2 aside = Vec2(seen.wv) * ((grid_.reference - height) / seen.wv.z);
  // Converts to texels, counted from the center of the first one.
  const Vec2 scale(static_cast<float>(texels_.width), static_cast<float>(texels_.height) / texels_.aspect);
  const TileTexels points{grid_.width, grid_.height, grid_.aspect};
  std::vector<LinearTexels> columns;
  for (uint32_t x = 0; x < grid_.width; ++x) {
    columns.emplace_back((points.center(x, 0).x + aside.x) * scale.x - 0.5f, texels_.width);
  }
  Evidence* evidence = evidence_.data() + size_t{z} * points.size();
  for (uint32_t y = 0; y < grid_.height; ++y) {
    const LinearTexels row((points.center(0, y).y + aside.y) * scale.y - 0.5f, texels_.height);
    for (const LinearTexels& column : columns) {
      const BilinearTexels at = bilinear_between(column, row, texels_.width);
      float coverage = 0;
      for (size_t k = 0; k < 4; ++k) coverage += at.weight[k] * seen.coverage[at.index[k]];
      insert(0.5f - coverage, evidence->open);
      if (!seen.height.empty()) add_distance(seen, surfaces, at, height, *evidence);
      ++evidence;
    }
  }
}

void ShellFusion::add_distance(const SeenTexels& seen, const Surfaces& surfaces, const BilinearTexels& at, float height,
                               Evidence& evidence) const {
  const auto heaviest = static_cast<size_t>(std::ranges::max_element(at.weight) - at.weight.begin());
  const uint32_t nearest = at.index[heaviest];
  const float weight = surfaces.weight[nearest];
  if (weight == 0) return;
  float mean = 0, sum = 0;
  for (size_t k = 0; k < 4; ++k) {
    const uint32_t t = at.index[k];
    const bool same =
        surfaces.weight[t] > 0 && std::abs(seen.height[t] - seen.height[nearest]) <= 2 * kSmooth * grid_.pitch();
    mean += same ? at.weight[k] * seen.height[t] : 0;
    sum += same ? at.weight[k] : 0;
  }
  const float before = seen.wv.z < 0 ? mean / sum - height : height - mean / sum;
  const float distance = before * surfaces.slant[nearest] / kBand;
  if (distance < -1) return;
  evidence.weight += weight;
  evidence.distance += weight * std::min(distance, 1.0f);
}

std::vector<float> ShellFusion::level() const {
  std::vector<float> level;
  const size_t layer = size_t{grid_.width} * grid_.height;
  for (size_t i = 0; i < evidence_.size(); ++i) {
    const Evidence& e = evidence_[i];
    const size_t z = i / layer;
    const bool outside = z + 1 == grid_.depth || (z == 0 && !closed_);  // these points lie beyond the structure
    const float seen = e.weight > 0 ? 0.5f * e.distance / e.weight : -0.5f;
    level.push_back(outside ? 0.5f : std::max(open(e), seen));
  }
  return level;
}

namespace {

constexpr float kOpen = 0.999f;   // a view with lower coverage sees through the structure
constexpr float kFar = 0.5f;      // search range for a structure of unknown extent, in widths from the plane
constexpr uint32_t kCoarse = 48;  // texels of the grid of that search
constexpr uint32_t kLines = 3;    // lines along a side of a texel, for the check

class DataVotf {
 public:
  DataVotf(const BtfMeasurement& btf, const DataVotfOptions& options, Progress& progress)
      : btf_(btf),
        options_(options),
        progress_(progress),
        texels_{btf.grid().width, btf.grid().height, tile_aspect(btf.grid())},
        width_(btf.grid().tile_metres ? btf.grid().tile_metres->x : 1.0f),
        heights_(btf.has_structure() && btf.shell()) {}

  VotfCapture run() {
    const auto start = std::chrono::steady_clock::now();
    look_through();
    if (heights_) {
      const Shell& shell = *btf_.shell();
      lay_out(in_widths(0), in_widths(shell.thickness), in_widths(shell.reference_height));
    } else {
      lay_out_hull();
    }
    progress_.stage("reading views", 0.2, 0.7);
    fill(fused(volume()));
    result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    progress_.stage("checking the silhouette", 0.8, 1);
    if (options_.check_views > 0) result_.errors = errors();
    return std::move(result_);
  }

 private:
  VotfVolume& volume() { return result_.volume; }
  size_t views() const { return btf_.layout().views().size(); }
  Vec3 direction_of(size_t view) const { return unit_direction(btf_.layout().views()[view]); }
  /// Converts a height over the lowest point to widths over the surface.
  float in_widths(double height) const { return static_cast<float>((height - options_.surface) / width_); }

  [[noreturn]] void refuse(Status status, const std::string& sentence) const {
    throw Error(status, btf_.provenance().path + ": " + sentence);
  }

  void look_through() {
    if (!btf_.has_coverage()) {
      refuse(Status::unsupported,
             "contains no coverage, which a silhouette (VOTF) requires. Use a BTF captured with Velour, or images with "
             "alpha.");
    }
    progress_.stage("reading coverage", 0, 0.1);
    volume().closed = true;
    for (uint32_t v = 0; v < views() && volume().closed; ++v) {
      progress_.check();
      if (direction_of(v).z < 0) continue;
      const auto coverage = btf_.read_coverage(v);
      volume().closed = !coverage || std::ranges::all_of(*coverage, [](float c) { return c >= kOpen; });
    }
    if (volume().closed && !heights_) {
      refuse(Status::unsupported,
             "no view sees through the structure, and the BTF contains no heights, so its silhouette (VOTF) is "
             "unknown. Use a BTF captured with Velour.");
    }
  }

  /// Heights in widths over the surface. The grid extends a point beyond the structure at both ends.
  void lay_out(float lowest, float highest, float reference) {
    VotfVolume& v = volume();
    const bool closed = v.closed;
    v = empty_shell(options_.texels > 0 ? options_.texels : texels_.width, texels_.aspect, lowest, highest);
    v.closed = closed;
    v.reference = reference;
    v.tile_width = btf_.grid().tile_metres ? width_ : 0.0f;
  }

  /// Without heights: computes a coarse hull over the whole search range, then lays out the range that it fills.
  void lay_out_hull() {
    const VotfVolume coarse = empty_shell(std::min(kCoarse, texels_.width), texels_.aspect, -kFar, kFar);
    progress_.stage("finding the height range", 0.1, 0.2);
    const std::vector<float> level = fused(coarse);
    const size_t layer = size_t{coarse.width} * coarse.height;
    uint32_t first = coarse.depth, last = 0;
    for (uint32_t z = 0; z < coarse.depth; ++z) {
      const auto at = level.begin() + static_cast<std::ptrdiff_t>(z * layer);
      if (std::all_of(at, at + static_cast<std::ptrdiff_t>(layer), [](float l) { return l > 0; })) continue;
      first = std::min(first, z);
      last = z;
    }
    if (first > last)
      refuse(Status::unsupported,
             "no part of the structure is covered in all views, so its silhouette (VOTF) is unknown. Check the alpha "
             "of the images and the directions of the views.");
    if (first <= 1 || last + 2 >= coarse.depth) {
      refuse(Status::unsupported,
             "the height of the structure cannot be determined from its views. Use a BTF with more grazing views.");
    }
    // Heights over the plane of the pictures.
    const float low = coarse.bottom + (static_cast<float>(first) - 1) * coarse.step();
    const float high = coarse.bottom + (static_cast<float>(last) + 1) * coarse.step();
    const float surface = static_cast<float>(options_.surface) / width_;
    lay_out(-surface, high - low - surface, -low - surface);
  }

  std::vector<float> fused(const VotfVolume& grid) {
    ShellFusion fusion(grid, texels_, grid.closed);
    for (uint32_t v = 0; v < views(); ++v) {
      progress_.check();
      progress_.update(static_cast<double>(v) / static_cast<double>(views()));
      add_view(v, fusion);
    }
    return fusion.level();
  }

  void add_view(uint32_t view, ShellFusion& fusion) const {
    if (!heights_) {
      if (const auto coverage = btf_.read_coverage(view)) fusion.add({direction_of(view), *coverage}, progress_);
      return;
    }
    ViewStructure seen = btf_.read_structure(view).value();
    for (float& h : seen.height_mean) h = in_widths(static_cast<double>(h));
    for (float& s : seen.height_spread) s /= width_;
    fusion.add({direction_of(view), seen.coverage, seen.height_mean, seen.height_spread}, progress_);
  }

  void fill(const std::vector<float>& level) {
    VotfVolume& v = volume();
    progress_.stage("computing distances", 0.7, 0.8);
    const std::vector<float> distance = level_distances(level, grid_of(v), progress_);
    v.distance.resize(distance.size());
    for (size_t i = 0; i < distance.size(); ++i) {
      v.distance[i] = distance_byte(std::copysign(distance[i], level[i]) / v.reach);
    }
  }

  /// Share of the lines through a texel that hit the volume.
  float met(const ShellField& field, size_t texel, const Vec3& wv) const {
    const Vec2 texel_size(1 / static_cast<float>(texels_.width), texels_.aspect / static_cast<float>(texels_.height));
    const Vec2 corner = texels_.center(texel) - 0.5f * texel_size;
    Vec2 place[kLines * kLines];
    for (uint32_t i = 0; i < kLines * kLines; ++i) {
      place[i] = corner + (Vec2(i % kLines, i / kLines) + 0.5f) / static_cast<float>(kLines) * texel_size;
    }
    uint8_t meets[kLines * kLines];
    lines_meet(field, place, wv, meets);
    return static_cast<float>(std::accumulate(meets, meets + kLines * kLines, 0)) / (kLines * kLines);
  }

  VotfErrors errors() {
    // Non-owning pointer: the volume outlives `field`.
    const ShellField field(std::shared_ptr<const VotfVolume>(std::shared_ptr<void>(), &volume()));
    const size_t count = std::min<size_t>(options_.check_views, views());
    std::vector<VotfErrors> seen(count);
    tbb::parallel_for(size_t{0}, count, [&](size_t i) {
      progress_.check();
      const auto view = static_cast<uint32_t>(i * views() / count);
      const auto coverage = btf_.read_coverage(view);
      for (size_t t = 0; coverage && t < texels_.size(); ++t) {
        const float truth = (*coverage)[t];
        seen[i].coverage += static_cast<double>(truth);
        seen[i].wrong += static_cast<double>(std::abs(truth - met(field, t, direction_of(view))));
      }
    });
    VotfErrors errors;
    for (const VotfErrors& e : seen) {
      errors.coverage += e.coverage / static_cast<double>(count * texels_.size());
      errors.wrong += e.wrong / static_cast<double>(count * texels_.size());
    }
    return errors;
  }

  const BtfMeasurement& btf_;
  const DataVotfOptions& options_;
  Progress& progress_;
  const TileTexels texels_;
  const float width_;  // meters per width, or 1 if unknown
  const bool heights_;
  VotfCapture result_;
};

}  // namespace

VotfCapture votf_of_data(const BtfMeasurement& btf, const DataVotfOptions& options, Progress& progress) {
  VotfCapture capture;
  tbb::task_arena arena(arena_concurrency(options.threads));
  arena.execute([&] { capture = DataVotf(btf, options, progress).run(); });
  return capture;
}

namespace {

constexpr float kReach = 8;  // range of the distances, in pitches
constexpr uint32_t kMinTexels = 4;

}  // namespace

VotfVolume empty_shell(uint32_t texels, float aspect, float lowest, float highest) {
  if (texels < kMinTexels || texels > VotfVolume::kMaxSide) {
    refuse("A silhouette (VOTF) cannot have " + std::to_string(texels) + " texels along x; the number must be " +
           std::to_string(kMinTexels) + " to " + std::to_string(VotfVolume::kMaxSide) + ".");
  }
  VotfVolume v;
  v.width = texels;
  v.aspect = aspect;
  v.height = std::max(1u, static_cast<uint32_t>(std::lround(static_cast<float>(v.width) * v.aspect)));
  v.bottom = lowest - v.pitch();
  v.top = highest + v.pitch();
  const double cells = std::ceil(static_cast<double>((v.top - v.bottom) / v.pitch()));
  if (!std::isfinite(cells)) refuse("The heights of a silhouette (VOTF) must be finite.");
  if (v.height > VotfVolume::kMaxSide || cells + 1 > VotfVolume::kMaxDepth ||
      uint64_t{v.width} * v.height * static_cast<uint64_t>(cells + 1) > VotfVolume::kMaxPoints) {
    refuse("A silhouette (VOTF) of " + std::to_string(v.width) + " x " + std::to_string(v.height) + " x " +
           std::to_string(static_cast<uint64_t>(cells) + 1) + " points is too large; reduce the number of texels.");
  }
  v.depth = static_cast<uint32_t>(cells) + 1;
  v.reach = kReach * v.pitch();
  return v;
}

DistanceGrid grid_of(const VotfVolume& v) {
  const TileTexels texels{v.width, v.height, v.aspect};
  return {v.width,
          v.height,
          v.depth,
          Vec3(texels.center(0), v.bottom),
          {v.pitch(), v.aspect / static_cast<float>(v.height), v.step()}};
}

}  // namespace velour

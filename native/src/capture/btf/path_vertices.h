// Vertices at which the paths of a block of texels hit the tile, and which the lights are then tested for.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>
#include "base/progress.h"
#include "btf/measure/btf_measurement.h"
#include "btf/measure/pair_layout.h"
#include "capture/btf/repeated_tile.h"
#include "material/material.h"
#include "render/path/vertex.h"

namespace velour {

// Partly transparent surfaces (alpha).

/// Lets each ray through a surface with probability 1 - Material::alpha, which is unbiased for any number of surfaces.
/// One per thread.
class Cutouts {
 public:
  explicit Cutouts(const RepeatedTile& tile);

  /// Whether any material of the tile lets rays through; if not, pass() need not be called.
  bool any() const { return any_; }
  /// Continues those `rays` whose `hits`, found by TileRays::intersect, let them through, and replaces both by the ray
  /// that ends the path and its hit. rays[i] takes its random numbers from keys[i]; `cone` is the rays' footprint.
  void pass(std::span<Ray> rays, std::span<Hit> hits, std::span<const uint64_t> keys, const RayCone& cone,
            TileRays& tracer, RayLog* log);

  /// Maximum number of surfaces that a ray passes through; rays that pass more count as misses.
  static constexpr int kMaxCrossings = 4096;

 private:
  bool goes_on(const Ray& ray, const Hit& hit, uint64_t key, int crossing, const RayCone& cone, Vec3& from) const;

  const RepeatedTile& tile_;
  bool any_ = false;
  std::vector<uint32_t> ids_;
  std::vector<Ray> next_;
  std::vector<Hit> next_hits_;
};

// One view of a capture: its direction and its lights.

struct CaptureLight {
  Vec3 wl;
  uint32_t number;       // index in the layout's set
  float per_irradiance;  // 1 / |cos(theta_l)|: the light's irradiance on the reference plane is its cosine
  RepeatedTile::Ends ends;
};

/// Maximum number of lights that are tested together.
inline constexpr uint32_t kLightsTogether = 128;

/// A group of a view's lights, as a structure of arrays.
struct LightGroup {
  std::span<const CaptureLight> lights;
  alignas(64) float x[kLightsTogether] = {}, y[kLightsTogether] = {}, z[kLightsTogether] = {};
  alignas(64) float per_irradiance[kLightsTogether] = {};

  /// Lights [first, first + kLightsTogether) of `all`, or fewer at its end.
  LightGroup(std::span<const CaptureLight> all, size_t first)
      : lights(all.subspan(first, std::min<size_t>(kLightsTogether, all.size() - first))) {
    for (size_t l = 0; l < lights.size(); ++l) {
      x[l] = lights[l].wl.x;
      y[l] = lights[l].wl.y;
      z[l] = lights[l].wl.z;
      per_irradiance[l] = lights[l].per_irradiance;
    }
  }
  uint32_t count() const { return static_cast<uint32_t>(lights.size()); }
};

struct ViewSetup {
  uint32_t number = 0;
  Vec3 wv{0, 0, 1};
  std::vector<CaptureLight> lights;

  ViewSetup(const RepeatedTile& tile, const PairLayout& layout, uint32_t view) : number(view) {
    wv = unit_direction(layout.views()[view]);
    for (uint64_t pair = layout.first(view); pair < layout.first(view + 1); ++pair) {
      const uint32_t light = layout.light_of(pair);
      const Vec3 wl = unit_direction(layout.lights()[light]);
      lights.push_back({wl, light, 1 / std::abs(wl.z), tile.ends(wl)});
    }
  }
};

// Blocks of texels that are traced together, and how texels are sampled.

/// Parameters that determine the values of every texel.
struct TexelSampling {
  uint32_t samples = 16;  // paths per texel and view
  uint32_t bounces = 1;   // further surfaces that a path meets after the first
  uint64_t seed = 0;
};

/// Texels [column, column + columns) x [row, row + rows).
struct TexelBlock {
  uint32_t column, row, columns, rows;
  uint32_t texels() const { return columns * rows; }
};

/// A grid divided into square blocks; the last of each row and column may be smaller. Their size depends on the
/// sampling alone, so that values do not depend on threads or memory.
class TexelBlocks {
 public:
  TexelBlocks(const TexelGrid& grid, const TexelSampling& sampling) : grid_(grid), side_(side(sampling)) {}

  uint32_t count() const { return columns() * rows(); }
  TexelBlock block(uint32_t number) const {
    const uint32_t column = number % columns() * side_, row = number / columns() * side_;
    return {column, row, std::min(side_, grid_.width - column), std::min(side_, grid_.height - row)};
  }

 private:
  /// Vertices per block, as measured: bounce rays profit from neighbors until the vertices no longer fit the caches.
  static constexpr double kVertices = 16384;
  static uint32_t side(const TexelSampling& s) {
    const double texels = kVertices / (static_cast<double>(s.samples) * (1.0 + s.bounces));
    return static_cast<uint32_t>(std::clamp(std::sqrt(texels), 1.0, 64.0));
  }
  uint32_t columns() const { return (grid_.width + side_ - 1) / side_; }
  uint32_t rows() const { return (grid_.height + side_ - 1) / side_; }

  TexelGrid grid_;
  uint32_t side_;
};

/// A point where a path hits the tile.
struct PathVertex {
  Vertex vertex;
  Rgb throughput;  // of the path from here to the viewer; working space
  uint64_t key;    // for the random numbers of its shadow rays through cutouts
};

/// Paths from the viewer through points of the texels, `samples` per texel; the paths of a texel are contiguous. One
/// per thread.
///
/// The points of a texel form a scrambled Sobol sequence; each further vertex samples its direction from the material
/// with such a sequence of its own. All random numbers depend on (seed, view, texel, sample, vertex) alone.
class PathVertices {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;

  PathVertices(const RepeatedTile& tile, const TexelGrid& grid, float reference_height, const TexelSampling& sampling)
      : tile_(tile), cutouts_(tile), grid_(grid), reference_height_(reference_height), sampling_(sampling) {}

  void trace(const ViewSetup& view, const TexelBlock& block, TileRays& rays, RayLog* log, const Progress& progress);

  uint32_t paths() const { return paths_; }
  /// Sorted by depth (first hits first), and within a depth so that neighbors in space are adjacent.
  std::span<const PathVertex> vertices() const { return vertices_; }
  /// Index of the first vertex of each depth, and the end.
  std::span<const uint32_t> depths() const { return depths_; }
  const RayCone& cone() const { return cone_; }
  /// The vertex of path `path` at `depth`, or kNone.
  uint32_t vertex_of(uint32_t path, uint32_t depth) const { return vertex_of_[size_t{depth} * paths_ + path]; }

 private:
  void start(const ViewSetup& view, const TexelBlock& block);
  Vec3 start_above(const Vec2& plane, const Vec3& wv) const;
  void pass_cutouts(uint32_t depth, TileRays& rays, RayLog* log);
  void meet(uint32_t depth);
  void go_on(uint32_t depth);
  uint64_t texel_key(const ViewSetup& view, uint32_t column, uint32_t row) const;
  uint64_t vertex_key(uint32_t path, uint32_t depth) const;

  const RepeatedTile& tile_;
  Cutouts cutouts_;
  const TexelGrid grid_;
  const float reference_height_;
  const TexelSampling sampling_;

  uint32_t paths_ = 0;
  std::vector<PathVertex> vertices_;
  std::vector<uint32_t> depths_, vertex_of_;
  std::vector<uint64_t> keys_;  // one per texel, for its random numbers
  std::vector<Vec2> points_;    // of one texel
  RayCone cone_;                // footprint of a path: the samples share the texel, as in PixelFootprint
  // The rays being traced.
  std::vector<Ray> rays_;
  std::vector<Rgb> throughput_;
  std::vector<uint32_t> path_of_;
  std::vector<Hit> hits_;
  std::vector<uint64_t> ray_keys_;
  std::vector<uint64_t> order_;  // Morton code of the hit, then the ray's index
  ScratchArena arena_;
};

}  // namespace velour

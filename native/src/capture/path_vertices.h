// Vertices at which the paths of a block of texels hit the tile, and which the lights are then tested for.
#pragma once

#include <span>
#include <vector>

#include "capture/cutouts.h"
#include "capture/repeated_tile.h"
#include "capture/texel_block.h"
#include "capture/view_setup.h"
#include "job/progress.h"
#include "material/material.h"
#include "render/vertex.h"

namespace velour {

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
  PreparedBrdf prepared_;
};

}  // namespace velour

// Captures one view of a tile: tests every light against the vertices of its paths, and sums what arrives.
#pragma once

#include <tbb/enumerable_thread_specific.h>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "base/memory.h"
#include "btf/formats/btf_folder.h"
#include "capture/btf/path_vertices.h"
#include "material/material.h"
#include "math/sphere/directions.h"
#include "math/sphere/frame.h"
#include "render/ray_log.h"

namespace velour {

// Memory of one view's images, or a file in place of it.

/// Zero-initialized array of halves; above `limit` bytes it is a temporary file in `folder` (see ScratchPages).
class ViewStore {
 public:
  /// Throws Error(io) if the file cannot be created.
  ViewStore(uint64_t halves, uint64_t limit, const std::string& folder)
      : halves_(halves), pages_(halves * sizeof(uint16_t), limit, folder) {}

  std::span<uint16_t> halves() const { return {static_cast<uint16_t*>(pages_.data()), halves_}; }
  /// Evicts the array from the process's memory; it is read back from the file on use. Thread-safe.
  void release() const { pages_.release(); }
  /// Runs `work`, which reads the array, and evicts what it has read in the meantime.
  void read_by(const std::function<void()>& work) const;

 private:
  const uint64_t halves_;
  const ScratchPages pages_;
};

// SIMD kernels for pairs of a place and a light.

/// Normals of many places, one array per component.
class PlaceNormals {
 public:
  void clear() { count_ = 0; }
  void push(const Vec3& geometric, const Vec3& shading);
  size_t count() const { return count_; }
  const float* component(size_t c) const { return components_[c].data(); }

 private:
  size_t count_ = 0;
  std::array<std::vector<float>, 6> components_;  // padded to whole vectors
};

/// Finds the numbers, ascending, of the places whose geometric and shading normals both face `wl`.
void facing_places(const PlaceNormals& normals, const Vec3& wl, std::vector<uint32_t>& numbers);

/// Lights that reach a place, stored contiguously.
struct LitLights {
  DirectionBatch wl;                                          // local, padded
  uint32_t number[DirectionBatch::kCapacity];                 // in the group
  alignas(64) float weight[DirectionBatch::kCapacity] = {0};  // factor of f: wl.z per_irradiance
};

/// Collects the lights in [first, first + 64) of `group` whose bit in `mask` is set.
void collect_lit(const LightGroup& group, uint32_t first, uint64_t mask, const Frame& frame, LitLights& lit);

/// Sums over paths for each light of a group.
struct PathSums {
  alignas(64) double sum[3][kLightsTogether];
  alignas(64) double luminance[kLightsTogether], luminance_sq[kLightsTogether];
};

/// Adds the contribution of each of the first `lights` lights along one path; omits values that are not finite and
/// returns their number. `luminance_weights`: for the color space of `path`.
uint32_t add_path(const float (&path)[3][kLightsTogether], const Vec3& luminance_weights, uint32_t lights,
                  PathSums& sums);

// Which lights reach which vertices.

/// One mask per vertex; bit l is set if light l of the group reaches it. One per thread.
class ShadowMasks {
 public:
  explicit ShadowMasks(const RepeatedTile& tile) : cutouts_(tile) {}

  using Mask = std::array<uint64_t, kLightsTogether / 64>;

  /// Traces light by light, because rays of one direction are traced in packets. Lights below a vertex's shading or
  /// geometric horizon need no ray.
  void trace(const PathVertices& paths, const LightGroup& group, TileRays& rays, RayLog* log, const Progress& progress);

  const Mask& of(uint32_t vertex) const { return masks_[vertex]; }

 private:
  void read(const PathVertices& paths);
  void try_light(const PathVertices& paths, const CaptureLight& light, uint32_t bit, TileRays& rays, RayLog* log);
  void trace_some(const PathVertices& paths, const CaptureLight& light, TileRays& rays, RayLog* log);
  void note_reached(uint32_t bit);
  void trace_through_cutouts(const PathVertices& paths, const CaptureLight& light, TileRays& rays, RayLog* log);

  // Data of the vertices, read for every light.
  PlaceNormals normals_;
  std::vector<Vec3> origins_;
  Cutouts cutouts_;
  std::vector<Mask> masks_;
  std::vector<uint32_t> facing_;   // vertices that face the light
  std::span<const uint32_t> ids_;  // the part of facing_ whose rays are being traced
  std::vector<Ray> rays_;
  std::vector<uint8_t> blocked_;
  // Used only if surfaces let rays through.
  std::vector<Hit> hits_;
  std::vector<uint64_t> keys_;
};

// Computes a texel's values from the vertices of its paths and the lights that reach them.

/// Sums over the samples of a texel for each light of a group.
struct TexelValues {
  PathSums sums;  // working space
  uint32_t samples;
  uint32_t broken;  // values that were not finite and count as 0

  Rgb mean(uint32_t light) const;  // working space
  /// Standard error of the mean's luminance, from the spread of the samples. An upper bound, because the samples are
  /// stratified. 0 for a single sample.
  float standard_error(uint32_t light) const;
};

/// One per thread.
class TexelShader {
 public:
  TexelShader(const Scene& scene, const TexelSampling& sampling);

  /// Computes the values of texel number `texel` of the block. `masks` must be those of `group`.
  void shade(const PathVertices& paths, uint32_t texel, const LightGroup& group, const ShadowMasks& masks,
             TexelValues& values);

 private:
  void shade_path(const PathVertices& paths, uint32_t path, const LightGroup& group, const ShadowMasks& masks);
  void shade_vertex(const PathVertex& at, const LightGroup& group, const ShadowMasks::Mask& mask);
  void add_lit(const PathVertex& at, const PreparedBrdf& brdf);

  const TexelSampling sampling_;
  const std::optional<Mat3>& rec709_to_working_;
  Vec3 luminance_weights_;  // for colors in the working space
  ScratchArena arena_;
  LitLights lit_;  // of one vertex
  RgbBatch f_;
  ScalarBatch pdf_;
  alignas(64) float path_[3][kLightsTogether];  // contribution of each light along one path
};

/// Destination of a view's images; layouts as in BtfView and ViewStructure.
struct ViewImages {
  std::span<HalfBits> values;
  std::span<HalfBits> errors;        // empty: not requested
  ViewStructure structure;           // of the grid's size
  const ViewStore* store = nullptr;  // holds `values` and `errors` if they may lie in a file
};

struct CaptureCounts {
  uint64_t rays = 0;    // traced
  uint64_t lost = 0;    // rays that never left the shell; they count as misses
  uint64_t broken = 0;  // values that were not finite; they count as 0
};

/// Captures views one after the other, block by block on all threads of the calling task arena. The result depends
/// neither on the number of threads nor on the order of the views.
class ViewCapture {
 public:
  /// `tile` must outlive this. `reference_height`: height of the reference plane (scene's z).
  ViewCapture(const RepeatedTile& tile, const TexelGrid& grid, float reference_height, const TexelSampling& sampling)
      : tile_(tile), grid_(grid), sampling_(sampling), blocks_(grid, sampling), workers_([this, reference_height] {
          return Worker(tile_, grid_, reference_height, sampling_);
        }) {
    if (const auto& to_working = tile.scene().rec709_to_working()) to_rec709_ = glm::inverse(*to_working);
  }

  /// Traces `view` into `images`. `begin`, `end`: its range of the progress stage. `share` may be null.
  void run(const ViewSetup& view, ViewImages& images, double begin, double end, RayShare* share, Progress& progress);

  CaptureCounts counts() const;

 private:
  struct Worker {
    PathVertices paths;
    TileRays rays;
    ShadowMasks masks;
    TexelShader shader;
    TexelValues values;
    uint64_t broken = 0;
    std::vector<float> mean, error;  // of a group of lights
    std::vector<HalfBits> mean_bits, error_bits;

    Worker(const RepeatedTile& tile, const TexelGrid& grid, float height, const TexelSampling& sampling)
        : paths(tile, grid, height, sampling), rays(tile), masks(tile), shader(tile.scene(), sampling) {}
  };
  void run_block(const ViewSetup& view, const TexelBlock& block, ViewImages& images, RayLog* log,
                 const Progress& progress);
  void shade_block(const LightGroup& group, uint32_t first_light, const TexelBlock& block, Worker& worker,
                   ViewImages& images, const Progress& progress);
  void store(uint64_t texel, uint32_t first_light, uint32_t lights, Worker& worker, ViewImages& images) const;
  void store_structure(const TexelBlock& block, const PathVertices& paths, ViewStructure& structure) const;

  const RepeatedTile& tile_;
  const TexelGrid grid_;
  const TexelSampling sampling_;
  const TexelBlocks blocks_;
  Mat3 to_rec709_{1.0f};  // from the scene's working space
  tbb::enumerable_thread_specific<Worker> workers_;
};

}  // namespace velour

// Captures all texels of one view.
#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <optional>
#include <span>

#include "btf/btf_folder.h"
#include "capture/path_vertices.h"
#include "capture/shadow_masks.h"
#include "capture/texel_values.h"
#include "capture/view_store.h"
#include "render/ray_share.h"

namespace velour {

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

// Fuses views of a structure into the solid part of its shell.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "base/progress.h"
#include "image/bilinear_texels.h"
#include "votf/eval/occlusion_volume.h"
#include "votf/eval/visibility_mask.h"

namespace velour {

/// Texels as seen in one view, [row][column] on the plane of the volume's `reference`.
struct SeenTexels {
  Vec3 wv;                          // unit; below the plane where z < 0
  std::span<const float> coverage;  // shares of the texels' rays that hit the structure
  std::span<const float> height{};  // of the first hits over the surface, in tile widths; empty: unknown
  std::span<const float> spread{};  // standard deviation of the heights
};

/// Combines two kinds of evidence about the points of a grid. A point that a view sees through is empty: the structure
/// lies within its visual hull ([Lau94]), with the border of the coverage interpolated between texels. If views have
/// heights, distances from the surfaces they see are averaged as in [CL96]: a view contributes to the points in front
/// of, or little behind, the surface it sees. Points that no view sees are solid.
class ShellFusion {
 public:
  /// The grid has the sizes of `volume`, whose distances are ignored. `closed`: solid below the grid.
  ShellFusion(const VotfVolume& volume, const TileTexels& texels, bool closed);

  void add(const SeenTexels& seen, const Progress& progress);
  /// One number per point, [z][y][x], positive outside, 0 on the surface; the input of level_distances().
  std::vector<float> level() const;

 private:
  static constexpr size_t kKept = 4;
  struct Evidence {
    std::array<float, kKept> open;   // the largest values of 1/2 - coverage, descending
    float weight = 0, distance = 0;  // sums; distances in kBand pitches, weighted

    Evidence() { open.fill(-0.5f); }
  };
  /// Coverage is noisy, and of many views, some are always too low: the lowest one per fifty views is ignored.
  float open(const Evidence& evidence) const { return evidence.open[std::min(kKept - 1, views_ / 50)]; }
  struct Surfaces;
  void add_layer(const SeenTexels& seen, const Surfaces& surfaces, uint32_t z);
  void add_distance(const SeenTexels& seen, const Surfaces& surfaces, const BilinearTexels& at, float height,
                    Evidence& evidence) const;

  const VotfVolume grid_;  // without distances
  const TileTexels texels_;
  const bool closed_;
  std::vector<Evidence> evidence_;  // [z][y][x]
  size_t views_ = 0;
};

}  // namespace velour

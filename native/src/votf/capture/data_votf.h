// Occlusion volume (VOTF) from the coverage and heights in a BTF's views, without the geometry.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>
#include "base/progress.h"
#include "btf/measure/btf_measurement.h"
#include "image/texels.h"
#include "votf/capture/surface_distance.h"
#include "votf/capture/votf_capture.h"
#include "votf/eval/occlusion_volume.h"

namespace velour {

// Fuses views of a structure into the solid part of its shell.

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

struct DataVotfOptions {
  uint32_t texels = 0;  // along x, at the same resolution along y and z; 0: those of the data
  double surface = 0;   // height of the carrying surface over the lowest point of the structure, in meters (in widths
                        // if the tile's size is unknown)
  uint32_t check_views = 64;  // views of the data, evenly spread, that the volume is compared with; 0: none
  int threads = 0;            // 0: all
};

/// Fuses coverage and heights of first hits (ShellFusion) if the BTF holds both; with coverage alone (alpha of
/// pictures) it computes the visual hull, whose extent is searched within half a width of the plane that the pictures
/// show. The volume is closed if no view from above sees through. `errors` compares it with the data's own views:
/// `wrong` is the mean difference between a texel's coverage and the share of kLines x kLines lines through it that hit
/// the volume. Throws Error(invalid_argument) for invalid grid sizes, Error(unsupported) if there is no coverage, or if
/// coverage alone does not determine the hull's extent.
VotfCapture votf_of_data(const BtfMeasurement& btf, const DataVotfOptions& options, Progress& progress);

// The grid of a tile's shell.

/// A volume without distances, but with their reach: `texels` points along x, the same resolution along y and z, and
/// one point beyond the structure at both ends, so that rays begin and end outside. `lowest` and `highest` are heights
/// over the surface that carries the shell, in tile widths. Throws Error(invalid_argument) for invalid sizes.
VotfVolume empty_shell(uint32_t texels, float aspect, float lowest, float highest);

/// Positions of the points of `volume`.
DistanceGrid grid_of(const VotfVolume& volume);

}  // namespace velour

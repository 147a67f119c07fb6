// What is solid in a shell, from what views of it show.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "btf/bilinear_texels.h"
#include "job/progress.h"
#include "votf/occlusion_volume.h"
#include "votf/visibility_mask.h"

namespace velour {

/// What one view shows of the texels, [row][column] on the plane of the volume's `reference`.
struct SeenTexels {
  Vec3 wv;                          // unit; below the plane where z < 0
  std::span<const float> coverage;  // shares of the texels' rays that meet the structure
  std::span<const float> height{};  // of what they meet first, over the surface, widths of the tile; empty: not known
  std::span<const float> spread{};  // standard deviation of the same
};

/// Two kinds of evidence about the points of a grid. Whatever a view sees through is empty: the structure lies within
/// its visual hull ([Lau94]), here with the border of the coverage between texels. And where views tell heights,
/// distances from what they see are averaged as in [CL96]: a point counts where it is before, or little behind, what
/// the view meets on the way to it. What no view sees is solid.
class ShellFusion {
 public:
  /// The sizes of `volume` are those of the grid; its distances are not looked at. `closed`: solid below the grid.
  ShellFusion(const OcclusionVolume& volume, const TileTexels& texels, bool closed);

  void add(const SeenTexels& seen, const Progress& progress);
  /// A number for every point, [z][y][x], positive outside, 0 on the surface: level_distances().
  std::vector<float> level() const;

 private:
  static constexpr size_t kKept = 4;
  struct Evidence {
    std::array<float, kKept> open;   // the largest of 1/2 - coverage, largest first
    float weight = 0, distance = 0;  // sums; distances in kBand pitches, weighted

    Evidence() { open.fill(-0.5f); }
  };
  /// Coverages are noisy, and of many views some are always too low: the one in fifty that shows least is not believed.
  float open(const Evidence& evidence) const { return evidence.open[std::min(kKept - 1, views_ / 50)]; }
  struct Surfaces;
  void add_layer(const SeenTexels& seen, const Surfaces& surfaces, uint32_t z);
  void add_distance(const SeenTexels& seen, const Surfaces& surfaces, const BilinearTexels& at, float height,
                    Evidence& evidence) const;

  const OcclusionVolume grid_;  // without distances
  const TileTexels texels_;
  const bool closed_;
  std::vector<Evidence> evidence_;  // [z][y][x]
  size_t views_ = 0;
};

}  // namespace velour

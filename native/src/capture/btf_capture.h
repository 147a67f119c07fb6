// A virtual goniometer for mesostructure: from a tile of geometry to a BTF.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "btf/polar_angles.h"
#include "capture/repeated_tile.h"
#include "capture/texel_block.h"
#include "job/progress.h"

namespace velour {

enum class CaptureSides { automatic, one, two };

struct BtfCaptureOptions {
  TilePlace place;               // period 0: that of the geometry's bounding box, both of its numbers
  double metres_per_unit = 1.0;  // of the scene; 0: not known
  uint32_t texels[2] = {128, 128};
  /// Above the plane; `sides` adds their mirror images below it. Given directions may also lie below; they are taken as
  /// they are, and `sides` adds nothing.
  std::vector<PolarAngles> views = capture_directions();
  std::vector<PolarAngles> lights = capture_directions();
  CaptureSides sides = CaptureSides::automatic;  // two where the tile is open
  /// Not 0: so many held_out_pairs() take the place of all pairs of `views` and `lights`, with random numbers of their
  /// own: what a model of a capture with the same seed is judged by.
  uint32_t held_out = 0;
  TexelSampling sampling;
  std::optional<double> reference_height;     // in the scene's z; none: least_variance_height
  uint64_t memory_limit = uint64_t{1} << 30;  // bytes that a view's images may hold; beyond it they lie in a file
  int threads = 0;                            // 0: all
  bool resume = false;
  bool measure_ray_share = false;
  std::string source = "tile";  // name of what is captured
};

struct BtfCaptureReport {
  double seconds = 0;  // of tracing and shading the views, without the reference plane and writing
  uint64_t rays = 0;
  double rays_per_second = 0;
  std::optional<double> ray_share;  // of the bare Embree rate for the same rays
  uint64_t bytes = 0;               // of the folder
  uint32_t views = 0, lights = 0, views_resumed = 0;
  uint64_t pairs = 0;
  bool two_sided = false, open = false;
  double thickness = 0, reference_height = 0;  // metres (units where their size is not known), over the lowest point
  std::vector<std::string> warnings;
};

/// Captures `scene`, which is committed, as a BTF in the folder `path`. Every view is written when it is done; a
/// capture that was killed goes on with `resume`, and ends with the same bits.
BtfCaptureReport capture_btf(const Scene& scene, const BtfCaptureOptions& options, const std::string& path,
                             Progress& progress);

}  // namespace velour

// A virtual goniometer for mesostructure: captures the BTF of a tile of geometry.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "base/warning.h"
#include "btf/measure/pair_layout.h"
#include "capture/btf/path_vertices.h"
#include "capture/btf/repeated_tile.h"

namespace velour {

enum class CaptureSides { automatic, one, two };

struct BtfCaptureOptions {
  TilePlace place;               // period (0, 0): the geometry's bounding box
  double metres_per_unit = 1.0;  // of the scene; 0: unknown
  uint32_t texels[2] = {128, 128};
  /// Directions above the plane, to which `sides` adds their mirror images. If any direction lies below the plane, all
  /// are used as given and `sides` adds nothing.
  std::vector<PolarAngles> views = capture_directions();
  std::vector<PolarAngles> lights = capture_directions();
  CaptureSides sides = CaptureSides::automatic;  // automatic: two if the tile is open
  /// If not 0: captures this many held_out_pairs() instead of all pairs of `views` and `lights`, with other random
  /// numbers, to validate models of a capture with the same seed.
  uint32_t held_out = 0;
  TexelSampling sampling;
  std::optional<double> reference_height;     // in the scene's z; none: least_variance_height()
  uint64_t memory_limit = uint64_t{1} << 30;  // bytes of a view's images; larger ones lie in a file
  int threads = 0;                            // 0: all
  bool resume = false;
  bool measure_ray_share = false;
  std::string source = "tile";  // name of the captured tile
};

struct BtfCaptureReport {
  double seconds = 0;  // for tracing and shading the views, without the reference plane and writing
  uint64_t rays = 0;
  double rays_per_second = 0;
  std::optional<double> ray_share;  // relative to the bare Embree rate for the same rays
  uint64_t bytes = 0;               // of the folder
  uint32_t views = 0, lights = 0, views_resumed = 0;
  uint64_t pairs = 0;
  bool two_sided = false, open = false;
  double thickness = 0, reference_height = 0;  // meters (tile widths if unknown), over the lowest point
  std::vector<Warning> warnings;
};

/// Captures the committed `scene` as a BTF in the folder `path`. Every view is written as soon as it is done; `resume`
/// continues an interrupted capture and gives the same bits.
BtfCaptureReport capture_btf(const Scene& scene, const BtfCaptureOptions& options, const std::string& path,
                             Progress& progress);

}  // namespace velour

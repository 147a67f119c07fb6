// From a tile of geometry to what its shell holds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capture/repeated_tile.h"
#include "job/progress.h"
#include "votf/occlusion_volume.h"

namespace velour {

struct OcclusionCaptureOptions {
  TilePlace place;                           // period 0: that of the geometry's bounding box, both of its numbers
  double metres_per_unit = 1.0;              // of the scene; 0: not known
  uint32_t texels = 128;                     // along x; y and z are as fine
  double surface = 0;                        // the scene's z that lies on the surface which will carry the shell
  std::optional<double> reference_height{};  // in the scene's z; none: least_variance_height
  uint32_t check_views = 64;                 // random views that the volume is compared with rays under; 0: not at all
  uint64_t seed = 0;                         // of those
  int threads = 0;                           // 0: all
  bool measure_ray_share = false;
};

struct OcclusionCapture {
  OcclusionVolume volume;
  std::optional<OcclusionErrors> errors;
  double seconds = 0;
  std::optional<double> ray_share;  // of the bare Embree rate for the same rays, those of the checks included
  std::vector<std::string> warnings;
};

/// `scene` is committed. Inside and outside are told apart along vertical rays by the facing of what they meet; a sheet
/// that is open below is solid down to the bottom where the tile is closed, and about a texel thick otherwise.
/// Throws Error(invalid_argument) for sizes that make no grid.
OcclusionCapture capture_occlusion(const Scene& scene, const OcclusionCaptureOptions& options, Progress& progress);

}  // namespace velour

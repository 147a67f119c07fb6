// Occlusion volume (VOTF) of a tile of geometry.
#pragma once

#include <optional>
#include <string>
#include <vector>
#include "base/progress.h"
#include "base/warning.h"
#include "capture/btf/repeated_tile.h"
#include "votf/eval/occlusion_volume.h"

namespace velour {

struct VotfCaptureOptions {
  TilePlace place;                           // period (0, 0): the geometry's bounding box
  double metres_per_unit = 1.0;              // of the scene; 0: unknown
  uint32_t texels = 128;                     // along x, at the same resolution along y and z
  double surface = 0;                        // the scene's z that will lie on the carrying surface
  std::optional<double> reference_height{};  // in the scene's z; none: least_variance_height()
  /// Whether the BTF whose texels lie on the reference plane has views from below; none: if the tile is open.
  std::optional<bool> two_sided{};
  uint32_t check_views = 64;  // random views in which the volume is compared with rays; 0: none
  uint64_t seed = 0;          // of the check views
  int threads = 0;            // 0: all
  bool measure_ray_share = false;
};

struct VotfCapture {
  VotfVolume volume;
  std::optional<VotfErrors> errors;
  double seconds = 0;
  std::optional<double> ray_share;  // relative to the bare Embree rate for the same rays, including the checks
  std::vector<Warning> warnings;
};

/// `scene` must be committed. Inside and outside are distinguished along vertical rays by the facing of the surfaces
/// they hit; a sheet that is open below is solid down to the bottom if the tile is closed, and about a texel thick
/// otherwise. Throws Error(invalid_argument) for invalid grid sizes.
VotfCapture capture_votf(const Scene& scene, const VotfCaptureOptions& options, Progress& progress);

// Coverage of texels in a view, by rays against the geometry itself.

/// V at the texels' centers on the plane of local height `reference`: 1 where the line through the center along `wv`
/// hits the tile. One ray per texel, one batch per row; `log` may be null.
std::vector<uint8_t> traced_mask(const RepeatedTile& tile, const TileTexels& texels, float reference, const Vec3& wv,
                                 RayLog* log = nullptr);

}  // namespace velour

// From what a BTF's views show of its structure to what its shell holds, without the geometry.
#pragma once

#include "btf/btf_measurement.h"
#include "capture/occlusion_capture.h"

namespace velour {

struct DataOcclusionOptions {
  uint32_t texels = 0;  // along x; y and z are as fine; 0: those of the data
  double surface = 0;   // what lies on the surface that will carry the shell: its height over the lowest point of the
                        // structure, metres, or widths where the tile's size is not known
  uint32_t check_views = 64;  // of the data, evenly spread, that the volume is compared with; 0: none
  int threads = 0;            // 0: all
};

/// Where a BTF holds heights of first hits as well as coverage, ShellFusion of both; where it holds coverage alone
/// (alpha of pictures), the visual hull, whose extent is looked for within half a width of the plane that the pictures
/// show. Closed: no view from above sees through. `errors` are against the data's own views: `wrong` is the mean
/// difference of a texel's coverage and the share of kLines x kLines lines through it that meet the volume. Throws
/// Error(invalid_argument) for sizes that make no grid, Error(unsupported) where there is no coverage, or nothing but
/// coverage and no view that sees through.
OcclusionCapture occlusion_of_data(const BtfMeasurement& btf, const DataOcclusionOptions& options, Progress& progress);

}  // namespace velour

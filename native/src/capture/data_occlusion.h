// Occlusion volume (VOTF) from the coverage and heights in a BTF's views, without the geometry.
#pragma once

#include "btf/btf_measurement.h"
#include "capture/occlusion_capture.h"

namespace velour {

struct DataOcclusionOptions {
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
OcclusionCapture occlusion_of_data(const BtfMeasurement& btf, const DataOcclusionOptions& options, Progress& progress);

}  // namespace velour

// Occlusion volume (VOTF) from the coverage and heights in a BTF's views, without the geometry.
#pragma once

#include "btf/measure/btf_measurement.h"
#include "votf/capture/surface_distance.h"
#include "votf/capture/votf_capture.h"
#include "votf/eval/occlusion_volume.h"

namespace velour {

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

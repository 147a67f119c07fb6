// The grid of a tile's shell.
#pragma once

#include "capture/surface_distance.h"
#include "votf/occlusion_volume.h"

namespace velour {

/// A volume without distances, but with their reach: `texels` points along x, the same resolution along y and z, and
/// one point beyond the structure at both ends, so that rays begin and end outside. `lowest` and `highest` are heights
/// over the surface that carries the shell, in tile widths. Throws Error(invalid_argument) for invalid sizes.
OcclusionVolume empty_shell(uint32_t texels, float aspect, float lowest, float highest);

/// Positions of the points of `volume`.
DistanceGrid grid_of(const OcclusionVolume& volume);

}  // namespace velour

// The grid of a tile's shell.
#pragma once

#include "capture/surface_distance.h"
#include "votf/occlusion_volume.h"

namespace velour {

/// A volume without distances: `texels` points along x, y and z as fine, a point beyond the structure at both ends, so
/// that a ray begins and ends outside; the reach of its distances. Heights over the surface that carries the shell, in
/// widths of the tile. Throws Error(invalid_argument) for sizes that make no grid.
OcclusionVolume empty_shell(uint32_t texels, float aspect, float lowest, float highest);

/// Where its points are.
DistanceGrid grid_of(const OcclusionVolume& volume);

}  // namespace velour

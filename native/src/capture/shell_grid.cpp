#include "capture/shell_grid.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "job/error.h"
#include "votf/visibility_mask.h"

namespace velour {
namespace {

constexpr float kReach = 8;  // range of the distances, in pitches
constexpr uint32_t kLeastTexels = 4;

}  // namespace

OcclusionVolume empty_shell(uint32_t texels, float aspect, float lowest, float highest) {
  if (texels < kLeastTexels || texels > OcclusionVolume::kMaxSide) {
    refuse("A silhouette (VOTF) cannot have " + std::to_string(texels) + " texels along x; the number must be " +
           std::to_string(kLeastTexels) + " to " + std::to_string(OcclusionVolume::kMaxSide) + ".");
  }
  OcclusionVolume v;
  v.width = texels;
  v.aspect = aspect;
  v.height = std::max(1u, static_cast<uint32_t>(std::lround(static_cast<float>(v.width) * v.aspect)));
  v.bottom = lowest - v.pitch();
  v.top = highest + v.pitch();
  const double cells = std::ceil(static_cast<double>((v.top - v.bottom) / v.pitch()));
  if (!std::isfinite(cells)) refuse("The heights of a silhouette (VOTF) must be finite.");
  if (v.height > OcclusionVolume::kMaxSide || cells + 1 > OcclusionVolume::kMaxDepth ||
      uint64_t{v.width} * v.height * static_cast<uint64_t>(cells + 1) > OcclusionVolume::kMaxPoints) {
    refuse("A silhouette (VOTF) of " + std::to_string(v.width) + " x " + std::to_string(v.height) + " x " +
           std::to_string(static_cast<uint64_t>(cells) + 1) + " points is too large; reduce the number of texels.");
  }
  v.depth = static_cast<uint32_t>(cells) + 1;
  v.reach = kReach * v.pitch();
  return v;
}

DistanceGrid grid_of(const OcclusionVolume& v) {
  const TileTexels texels{v.width, v.height, v.aspect};
  return {v.width,
          v.height,
          v.depth,
          Vec3(texels.centre(0), v.bottom),
          {v.pitch(), v.aspect / static_cast<float>(v.height), v.step()}};
}

}  // namespace velour

// Random points of a relief with their values in all views, by which lobes are chosen and refined.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>
#include "btf/fit/side_views.h"
#include "btf/measure/relief.h"
#include "math/srbf/multivariate_lobes.h"

namespace velour {

struct SurfacePoint {
  Vec2 place;      // in tiles
  Mat3 to_normal;  // from the tile's frame to that of the relief's normal
  std::vector<LobeArguments> pair;
  std::array<std::vector<float>, 3> value;  // per pair, along the color axes
};

/// Where a view's image shows the relief point at `place` and `height`: a position on the reference plane, in tiles.
/// Empty if the ray there ends more than three quarters of a texel from the point. `aspect`: tile_aspect().
std::optional<Vec2> shown_at(const Relief& relief, const Vec2& place, float height, float aspect, const Vec3& wv);

struct SurfacePointOptions {
  uint32_t points = 0;
  uint32_t pairs = 0;  // per point that every view sees, approximately
  uint64_t seed = 0;
};

/// Reads every view once. Visibility: shown_at().
std::vector<SurfacePoint> surface_points(CompandedViews& views, const TexelGrid& grid, const SideDirections& side,
                                         const Relief& relief, const SurfacePointOptions& options, Progress& progress);

// Partition of loops over texels for threads.

/// Texels per piece of work. Fixed, so that sums do not depend on the number of threads.
inline constexpr size_t kTexelsPerPiece = 64;

}  // namespace velour

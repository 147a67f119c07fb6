// Random points of a relief with what all views show of them: what lobes are chosen and refined by.
#pragma once

#include <optional>
#include <vector>

#include "btf/relief.h"
#include "compress/side_views.h"
#include "srbf/multivariate_lobes.h"

namespace velour {

struct SurfacePoint {
  Vec2 place;      // in tiles
  Mat3 to_normal;  // the tile's frame to that of the relief's normal
  std::vector<LobeArguments> pair;
  std::array<std::vector<float>, 3> value;  // along the colour axes, of each pair
};

/// Where a view's image shows the point of a relief at `place` and `height`, on the reference plane, in tiles; nothing
/// where its ray there ends more than three quarters of a texel from the point. `aspect`: tile_aspect().
std::optional<Vec2> shown_at(const Relief& relief, const Vec2& place, float height, float aspect, const Vec3& wv);

struct SurfacePointOptions {
  uint32_t points = 0;
  uint32_t pairs = 0;  // of a point that every view sees, about
  uint64_t seed = 0;
};

/// Reads every view once. What each view shows: shown_at().
std::vector<SurfacePoint> surface_points(CompandedViews& views, const TexelGrid& grid, const SideDirections& side,
                                         const Relief& relief, const SurfacePointOptions& options, Progress& progress);

}  // namespace velour

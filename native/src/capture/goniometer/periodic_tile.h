// One period of a surface, traced as if it repeated forever.
#pragma once

#include <cstdint>
#include <vector>

#include "capture/goniometer/height_field.h"
#include "scene/embree_scene.h"

namespace velour {

/// A point just above the surface: rays that leave it to the upper side of its facet cannot hit the facet again.
struct FacetPoint {
  Vec3 position{0, 0, 0};
  Vec3 normal{0, 0, 1};  // of the flat facet, unit, z > 0
  bool base = false;     // diffuse base instead of metal
};

enum class Fate { hit, escaped, lost };

/// Rays that leave the tile sideways re-enter at the opposite side. Immutable after construction, thread-safe.
class PeriodicTile {
 public:
  /// `base_cells` [cells^2] marks the cells of diffuse base; empty: none.
  PeriodicTile(HeightField field, std::vector<uint8_t> base_cells);

  int facets() const { return 2 * field_.cells * field_.cells; }
  /// dz/dx and dz/dy of facet `facet`, which covers 1 / facets() of the mean plane.
  Vec2 slope(int facet) const;
  bool is_base(int facet) const { return !base_cells_.empty() && base_cells_[static_cast<size_t>(facet / 2)] != 0; }

  /// The surface above a point of the mean plane; u uniform in [0, 1)^2 makes it uniform over that plane's area.
  FacetPoint point_above(const Vec2& u) const;

  /// A point at the height of the surface's top, for rays that come down; u as in point_above().
  Vec3 place_above(const Vec2& u) const { return {u * period_, top_}; }

  /// First hit on the surface. Rays are `lost` if rounding takes them below it, or if they are so flat that they cross
  /// kMaxPeriods periods without a hit.
  Fate trace(const Vec3& origin, const Vec3& direction, FacetPoint& hit) const;
  /// True if the ray hits nothing and is not lost.
  bool escapes(const Vec3& origin, const Vec3& direction) const;

  static constexpr int kMaxPeriods = 256;

 private:
  bool enter_next_period(Ray& ray) const;
  FacetPoint surface_point(int facet, const Vec3& position) const;

  HeightField field_;
  std::vector<uint8_t> base_cells_;
  EmbreeScene scene_;
  Vec2 period_;
  float top_ = 0;   // highest point of the surface
  float lift_ = 0;  // offset of surface points along their normal, against rounding
};

}  // namespace velour

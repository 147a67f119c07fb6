// Inside and outside of a tile's structure along vertical lines.
#pragma once

#include <vector>

#include "capture/repeated_tile.h"
#include "render/ray_share.h"

namespace velour {

/// Counts how often vertical lines from above have entered the structure without leaving it, by the facing of the
/// surfaces they hit.
class ShellColumns {
 public:
  /// Follows lines through `places` (local coordinates). A line must end outside the structure if the tile is open, and
  /// inside if it is closed; a line that does not is retried a little to the side, by at most about `aside`.
  ShellColumns(const RepeatedTile& tile, const std::vector<Vec2>& places, float aside, bool closed, RayShare& share);

  /// Whether `height` on a line is inside. A line of an open tile that never leaves the structure has hit a sheet,
  /// which has no inside.
  bool inside(size_t line, float height) const;
  /// Number of lines that ended wrongly in all tries.
  size_t unclosed() const { return unclosed_; }

 private:
  struct Crossing {
    float height;
    int depth;  // below the crossing
  };
  using Line = std::vector<Crossing>;
  /// Follows adjacent lines together, with a batch of rays for each crossing.
  void follow(std::span<const Vec2> places, float aside, std::span<Line> lines, RayLog* log) const;
  std::vector<Line> followed(TileRays& rays, std::span<const Vec2> places, RayLog* log) const;
  bool ends_well(const Line& line) const;

  const RepeatedTile& tile_;
  const bool closed_;
  std::vector<Line> lines_;
  size_t unclosed_ = 0;
};

}  // namespace velour

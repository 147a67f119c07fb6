// What is inside of a tile's structure, along vertical lines.
#pragma once

#include <vector>

#include "capture/repeated_tile.h"
#include "render/ray_share.h"

namespace velour {

/// How often a vertical line from above has gone into the structure and not come out, by the facing of what it meets.
class ShellColumns {
 public:
  /// Lines through `places`, local coordinates. One that does not end as all others of its tile do - with nothing left
  /// to come out of where the tile is open, within it where that is closed - is tried again a little to the side,
  /// `aside` at most.
  ShellColumns(const RepeatedTile& tile, const std::vector<Vec2>& places, float aside, bool closed, RayShare& share);

  /// Whether `height` of a line is inside. A line of an open tile that never comes out has met a sheet, which has no
  /// inside.
  bool inside(size_t line, float height) const;
  /// Lines that ended otherwise to the last.
  size_t unclosed() const { return unclosed_; }

 private:
  struct Crossing {
    float height;
    int depth;  // below it
  };
  using Line = std::vector<Crossing>;
  /// Lines that lie side by side, a batch of rays for each of their crossings.
  void follow(std::span<const Vec2> places, float aside, std::span<Line> lines, RayLog* log) const;
  std::vector<Line> followed(TileRays& rays, std::span<const Vec2> places, RayLog* log) const;
  bool ends_well(const Line& line) const;

  const RepeatedTile& tile_;
  const bool closed_;
  std::vector<Line> lines_;
  size_t unclosed_ = 0;
};

}  // namespace velour

// What is inside of a tile's structure, along vertical lines.
#pragma once

#include <vector>

#include "capture/repeated_tile.h"

namespace velour {

/// How often a vertical line from above has gone into the structure and not come out, by the facing of what it meets.
class ShellColumns {
 public:
  /// Lines through `places`, local coordinates. One that does not end as all others of its tile do - with nothing left
  /// to come out of where the tile is open, within it where that is closed - is tried again a little to the side,
  /// `aside` at most.
  ShellColumns(const RepeatedTile& tile, const std::vector<Vec2>& places, float aside, bool closed);

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
  std::vector<Crossing> follow(TileRays& rays, const Vec2& place) const;
  bool ends_well(const std::vector<Crossing>& line) const;

  const RepeatedTile& tile_;
  const bool closed_;
  std::vector<std::vector<Crossing>> lines_;
  size_t unclosed_ = 0;
};

}  // namespace velour

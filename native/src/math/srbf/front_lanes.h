// Table of the lanes in masks of up to eight lanes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace velour {

/// Lanes of each mask in ascending order, followed by zeros.
struct FrontLaneTable {
  uint8_t lane[256][8];

  constexpr FrontLaneTable() : lane{} {
    for (size_t mask = 0; mask < 256; ++mask) {
      size_t count = 0;
      for (uint8_t i = 0; i < 8; ++i) {
        if ((mask >> i & 1) != 0) lane[mask][count++] = i;
      }
    }
  }
};
inline constexpr FrontLaneTable kFrontLanes;

}  // namespace velour

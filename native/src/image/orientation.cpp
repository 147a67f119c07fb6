#include "image/orientation.h"

#include <algorithm>
#include <array>

namespace velour {
namespace {

/// Corner of the stored pixels where the upright picture's first pixel lies.
struct Origin {
  bool right = false, bottom = false;
};

Origin origin_of(Orientation orientation) {
  switch (orientation) {
    case Orientation::mirrored:
    case Orientation::turned_ccw:
      return {.right = true};
    case Orientation::flipped:
    case Orientation::turned_cw:
      return {.bottom = true};
    case Orientation::turned_180:
    case Orientation::transversed:
      return {.right = true, .bottom = true};
    case Orientation::normal:
    case Orientation::transposed:
      break;
  }
  return {};
}

}  // namespace

Picture upright(Picture stored, Orientation orientation) {
  if (orientation == Orientation::normal) return stored;
  const bool swapped = swaps_sides(orientation);
  Picture result{swapped ? stored.height : stored.width, swapped ? stored.width : stored.height, stored.channels, {}};
  result.pixels.resize(stored.pixels.size());
  const Origin origin = origin_of(orientation);
  float* out = result.pixels.data();
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x, out += stored.channels) {
      const int column = swapped ? y : x, row = swapped ? x : y;
      const float* in = stored.pixel(origin.right ? stored.width - 1 - column : column,
                                     origin.bottom ? stored.height - 1 - row : row);
      std::copy_n(in, stored.channels, out);
    }
  }
  return result;
}

std::string name_of(Orientation orientation) {
  constexpr std::array<const char*, 9> kNames{"",
                                              "upright",
                                              "mirrored",
                                              "rotated by 180 degrees",
                                              "flipped vertically",
                                              "transposed",
                                              "rotated by 90 degrees",
                                              "mirrored and rotated by 90 degrees",
                                              "rotated by 270 degrees"};
  return kNames[static_cast<size_t>(orientation)];
}

}  // namespace velour

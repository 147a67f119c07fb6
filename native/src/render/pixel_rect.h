// Rectangle of pixels.
#pragma once

namespace velour {

struct PixelRect {
  int x0, y0, x1, y1;  // [x0, x1) x [y0, y1); row 0 is at the bottom
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
  bool operator==(const PixelRect&) const = default;
};

}  // namespace velour

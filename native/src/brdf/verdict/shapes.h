// The shapes that a verdict looks at: their normals and tangents, pixel by pixel.
#pragma once

#include <cstdint>
#include <vector>
#include "math/sphere/frame.h"

namespace velour {

/// World: +x right, +y up, +z towards the viewer, who is infinitely far away.
struct Shape {
  struct Pixel {
    uint32_t index;  // in the picture, row by row from the top
    Frame frame;     // in the world; z: the normal, which faces the viewer; x: the tangent, along the brushing
  };
  std::vector<Pixel> pixels;  // those that show the shape
};

/// A picture of `side` x `side` pixels of a ball, which shows every angle between view and surface evenly.
Shape ball_shape(int side);

/// A ring seen obliquely: hollow parts, and surfaces that turn quickly and slowly.
Shape ring_shape(int side);

}  // namespace velour

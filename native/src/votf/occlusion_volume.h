// What is solid in the shell over a surface.
#pragma once

#include <cstdint>
#include <vector>

namespace velour {

/// Signed distances to the surface of one tile's structure, periodic in x and y, on points of a grid; positive outside.
/// Lengths are widths of the tile, so a tile's x runs over [0, 1) and its y over [0, aspect). Heights are over the
/// surface that carries the shell.
///
/// It stands for the view-dependent occlusion V(t, wv) of every texel t and view wv: whether the line through t along
/// wv is blocked, between the views of a measurement and on curved surfaces as well (shell_trace.h).
struct OcclusionVolume {
  uint32_t width = 0, height = 0, depth = 0;  // points along x and y, in the middles of cells, and along z
  float aspect = 1;
  float bottom = 0, top = 0;      // heights of the first and of the last points of z
  float reference = 0;            // height of the plane that a BTF of the tile has its texels on
  float reach = 0;                // the longest distance that is told apart
  bool closed = false;            // no vertical line comes through
  float tile_width = 0;           // metres; 0: not known
  std::vector<uint8_t> distance;  // [z][y][x]: 1 stands for -reach, 255 for reach, 128 for 0

  uint64_t parameter_bytes() const { return distance.size(); }
  float pitch() const { return 1.0f / static_cast<float>(width); }
  float step() const { return depth > 1 ? (top - bottom) / static_cast<float>(depth - 1) : 1.0f; }

  static constexpr uint32_t kMaxSide = 4096, kMaxDepth = 1024;
  static constexpr uint64_t kMaxPoints = uint64_t{1} << 28;
  static constexpr int kZero = 128, kUnits = 127;
};

/// The volume against rays that meet the geometry itself, over views uniform by solid angle up to 75 degrees.
struct OcclusionErrors {
  double coverage = 0;  // mean V of the views
  double wrong = 0;     // share of texel centres and views whose visibility the volume gets wrong
};

/// The byte of a distance, as a share of the reach.
uint8_t distance_byte(float share);

}  // namespace velour

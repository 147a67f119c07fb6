// VOTF volume: which points of the shell over a surface are solid.
#pragma once

#include <cstdint>
#include <vector>

namespace velour {

/// Signed distances to the surface of a tile's structure at the points of a grid, periodic in x and y; positive
/// outside. Lengths are in tile widths: a tile's x runs over [0, 1) and its y over [0, aspect). Heights are above the
/// surface that carries the shell.
///
/// Represents the view-dependent occlusion V(t, wv) of every texel t and view wv, i.e. whether the line through t along
/// wv is blocked, also between the measured views and on curved surfaces (shell_trace.h).
struct VotfVolume {
  uint32_t width = 0, height = 0, depth = 0;  // grid points; x and y at the centers of cells
  float aspect = 1;
  float bottom = 0, top = 0;      // heights of the first and the last grid points along z
  float reference = 0;            // height of the plane of the texels of a BTF of the tile
  float reach = 0;                // distances are clamped to it
  bool closed = false;            // no vertical line passes through
  float tile_width = 0;           // meters; 0: unknown
  std::vector<uint8_t> distance;  // [z][y][x]: 1 stands for -reach, 255 for reach, 128 for 0

  uint64_t parameter_bytes() const { return distance.size(); }
  float pitch() const { return 1.0f / static_cast<float>(width); }
  float step() const { return depth > 1 ? (top - bottom) / static_cast<float>(depth - 1) : 1.0f; }

  static constexpr uint32_t kMaxSide = 4096, kMaxDepth = 1024;
  static constexpr uint64_t kMaxPoints = uint64_t{1} << 28;
  static constexpr int kZero = 128, kUnits = 127;
};

/// Error of the volume against rays traced through the geometry itself, over views uniform in solid angle up to 75
/// degrees.
struct VotfErrors {
  double coverage = 0;  // mean V over the views
  double wrong = 0;     // share of (texel center, view) pairs with wrong visibility
};

/// Byte that encodes a distance, given as a share of the reach.
uint8_t distance_byte(float share);

}  // namespace velour

// VOTF volume: which points of the shell over a surface are solid, and which texels are occluded in a view.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>
#include "math/sphere/vec.h"

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

// Look-up of distances in a shell.

/// The data of a volume that the look-up kernels need.
struct ShellTable {
  const uint8_t* column;          // [y][x][z], y and x one longer (periodic); readable for 4 bytes from each point
  uint32_t width, height, depth;  // points
  uint32_t row;                   // points between consecutive y
  float bottom, top, pitch;       // tile widths
  float per_step;                 // points along z per tile width
  float per_aspect;               // periods along y per tile width
  float unit;                     // tile widths per unit of the bytes
};

/// Immutable, thread-safe.
class ShellField {
 public:
  explicit ShellField(std::shared_ptr<const VotfVolume> volume);

  const VotfVolume& volume() const { return *volume_; }
  const ShellTable& table() const { return table_; }
  /// Signed distance at `q` in tile widths, trilinear; x and y repeat, z is clamped to the volume.
  float distance(const Vec3& q) const;
  /// Gradient of the distance: the outward normal near the surface, not normalized.
  Vec3 gradient(const Vec3& q) const;

 private:
  std::shared_ptr<const VotfVolume> volume_;
  std::vector<uint8_t> column_;  // the points of a column, along z, are contiguous
  ShellTable table_;
};

// Texels of a tile that are occluded in a view.

/// Texels over one period of a tile, [row][column]; row 0 is at y = 0.
struct TileTexels {
  uint32_t width, height;
  float aspect;  // height / width of the tile

  size_t size() const { return size_t{width} * height; }
  /// Center of a texel, in tile widths.
  Vec2 center(uint32_t x, uint32_t y) const {
    return {(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
            (static_cast<float>(y) + 0.5f) / static_cast<float>(height) * aspect};
  }
  Vec2 center(size_t texel) const {
    return center(static_cast<uint32_t>(texel % width), static_cast<uint32_t>(texel / width));
  }
};

/// View `i` for validating a volume: uniform in solid angle up to 75 degrees.
Vec3 check_view(uint64_t seed, uint32_t i);

/// V at the texel centers for a view: 1 where the line through the center along `wv` meets the structure.
std::vector<uint8_t> visibility_mask(const ShellField& field, const TileTexels& texels, const Vec3& wv);

}  // namespace velour

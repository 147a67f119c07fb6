// Look-up of distances in a shell.
#pragma once

#include <memory>
#include <vector>

#include "math/sphere/vec.h"
#include "votf/eval/occlusion_volume.h"

namespace velour {

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

}  // namespace velour

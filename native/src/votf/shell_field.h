// Distances in a shell, ready to be looked up.
#pragma once

#include <memory>
#include <vector>

#include "sphere/vec.h"
#include "votf/occlusion_volume.h"

namespace velour {

/// What a look-up needs of a volume, for kernels.
struct ShellTable {
  const uint8_t* column;          // [y][x][z], one more of each side, repeated; readable for 4 bytes from each point
  uint32_t width, height, depth;  // points
  uint32_t row;                   // points from one y to the next
  float bottom, top, pitch;       // widths
  float per_step;                 // points of z a width
  float per_aspect;               // periods along y a width
  float unit;                     // widths a unit of the bytes
};

/// Immutable, thread-safe.
class ShellField {
 public:
  explicit ShellField(std::shared_ptr<const OcclusionVolume> volume);

  const OcclusionVolume& volume() const { return *volume_; }
  const ShellTable& table() const { return table_; }
  /// Signed distance at `q`, trilinear, widths of the tile; x and y repeat, z is held within the volume.
  float distance(const Vec3& q) const;
  /// Its gradient: the outward normal near the surface, not normalised.
  Vec3 gradient(const Vec3& q) const;

 private:
  std::shared_ptr<const OcclusionVolume> volume_;
  std::vector<uint8_t> column_;  // what a look-up needs of a column lies side by side
  ShellTable table_;
};

}  // namespace velour

// Distances in a shell, ready to be looked up.
#pragma once

#include <memory>
#include <vector>

#include "sphere/vec.h"
#include "votf/occlusion_volume.h"

namespace velour {

/// Immutable, thread-safe.
class ShellField {
 public:
  explicit ShellField(std::shared_ptr<const OcclusionVolume> volume);

  const OcclusionVolume& volume() const { return *volume_; }
  /// Signed distance at `q`, trilinear, widths of the tile; x and y repeat, z is held within the volume.
  float distance(const Vec3& q) const;
  /// Its gradient: the outward normal near the surface, not normalised.
  Vec3 gradient(const Vec3& q) const;

 private:
  std::shared_ptr<const OcclusionVolume> volume_;
  // [y][x][z]: what a look-up needs of a column lies side by side. One more of each side, repeated.
  std::vector<uint8_t> column_;
  float per_step_;    // points of z a width
  float per_aspect_;  // periods along y a width
  float unit_;        // widths a unit of the bytes
  size_t row_;        // of column_
};

}  // namespace velour

#include "votf/shell_field.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

struct Cell {
  size_t index;
  float part;
};

/// The point before `periods`, of `points` in the middles of as many cells of a period, and how far beyond it.
Cell periodic_cell(float periods, uint32_t points) {
  const float at = (periods - std::floor(periods)) * static_cast<float>(points) - 0.5f;
  if (at < 0) return {points - size_t{1}, at + 1};
  const auto before = static_cast<uint32_t>(at);
  return {before, at - static_cast<float>(before)};
}

}  // namespace

ShellField::ShellField(std::shared_ptr<const OcclusionVolume> volume)
    : volume_(std::move(volume)),
      per_step_(1.0f / volume_->step()),
      unit_(volume_->reach / OcclusionVolume::kUnits),
      row_((size_t{volume_->width} + 1) * volume_->depth) {
  const OcclusionVolume& v = *volume_;
  column_.resize((size_t{v.height} + 1) * row_);
  for (size_t y = 0; y <= v.height; ++y) {
    for (size_t x = 0; x <= v.width; ++x) {
      const size_t from = (y % v.height) * v.width + x % v.width;
      for (size_t z = 0; z < v.depth; ++z) {
        column_[y * row_ + x * v.depth + z] = v.distance[z * v.height * v.width + from];
      }
    }
  }
}

float ShellField::distance(const Vec3& q) const {
  const OcclusionVolume& v = *volume_;
  const Cell x = periodic_cell(q.x, v.width), y = periodic_cell(q.y / v.aspect, v.height);
  const float z = std::clamp((q.z - v.bottom) * per_step_, 0.0f, static_cast<float>(v.depth - 1));
  const size_t iz = std::min(static_cast<size_t>(z), size_t{v.depth} - 2);
  const float pz = z - static_cast<float>(iz);
  const uint8_t* const at = column_.data() + y.index * row_ + x.index * v.depth + iz;
  const auto along_z = [&](const uint8_t* p) {
    const float low = p[0], high = p[1];
    return low + pz * (high - low);
  };
  const auto along_x = [&](const uint8_t* p) {
    const float low = along_z(p), high = along_z(p + v.depth);
    return low + x.part * (high - low);
  };
  const float low = along_x(at), high = along_x(at + row_);
  return unit_ * (low + y.part * (high - low) - OcclusionVolume::kZero);
}

Vec3 ShellField::gradient(const Vec3& q) const {
  const float h = 0.5f * volume_->pitch();
  const auto slope = [&](const Vec3& d) { return distance(q + d) - distance(q - d); };
  return Vec3(slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})) / (2 * h);
}

}  // namespace velour

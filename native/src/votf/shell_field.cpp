#include "votf/shell_field.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace velour {
namespace {

struct Cell {
  size_t index;
  float part;
};

/// What is behind the point, in [0, 1); 0 where a float has no room for it. std::floor would be a call into a library.
float fraction(float x) {
  if (!(std::abs(x) < 0x1p23f)) return 0;
  const float part = x - static_cast<float>(static_cast<int32_t>(x));
  return part < 0 ? part + 1 : part;
}

/// The point before `periods`, of `points` in the middles of as many cells of a period, and how far beyond it.
Cell periodic_cell(float periods, uint32_t points) {
  const float at = fraction(periods) * static_cast<float>(points) - 0.5f;
  if (at < 0) return {points - size_t{1}, at + 1};
  const auto before = std::min(static_cast<int32_t>(at), static_cast<int32_t>(points) - 1);
  return {static_cast<size_t>(before), at - static_cast<float>(before)};
}

/// Two points that follow each other along z, in each of four columns.
struct Corners {
  float low[4], high[4];

  void take(size_t column, const uint8_t* at) {
    low[column] = at[0];
    high[column] = at[1];
  }
};

}  // namespace

ShellField::ShellField(std::shared_ptr<const OcclusionVolume> volume)
    : volume_(std::move(volume)),
      per_step_(1.0f / volume_->step()),
      per_aspect_(1.0f / volume_->aspect),
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
  const Cell x = periodic_cell(q.x, v.width), y = periodic_cell(q.y * per_aspect_, v.height);
  const float z = std::clamp((q.z - v.bottom) * per_step_, 0.0f, static_cast<float>(v.depth - 1));
  const size_t iz = std::min(static_cast<size_t>(z), size_t{v.depth} - 2);
  const float pz = z - static_cast<float>(iz);
  const uint8_t* const at = column_.data() + y.index * row_ + x.index * v.depth + iz;
  Corners corners;
  corners.take(0, at);
  corners.take(1, at + v.depth);
  corners.take(2, at + row_);
  corners.take(3, at + row_ + v.depth);
  float along_z[4];
  for (size_t i = 0; i < 4; ++i) along_z[i] = corners.low[i] + pz * (corners.high[i] - corners.low[i]);
  const float low = along_z[0] + x.part * (along_z[1] - along_z[0]);
  const float high = along_z[2] + x.part * (along_z[3] - along_z[2]);
  return unit_ * (low + y.part * (high - low) - OcclusionVolume::kZero);
}

Vec3 ShellField::gradient(const Vec3& q) const {
  const float h = 0.5f * volume_->pitch();
  const auto slope = [&](const Vec3& d) { return distance(q + d) - distance(q - d); };
  return Vec3(slope({h, 0, 0}), slope({0, h, 0}), slope({0, 0, h})) / (2 * h);
}

}  // namespace velour

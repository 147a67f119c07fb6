#include "votf/eval/occlusion_volume.h"

#include <algorithm>
#include <cmath>

#include "math/sphere/random.h"
#include "votf/eval/shell_trace.h"

namespace velour {

uint8_t distance_byte(float share) {
  const float units = std::clamp(share, -1.0f, 1.0f) * VotfVolume::kUnits;
  return static_cast<uint8_t>(VotfVolume::kZero + static_cast<int>(std::lround(units)));
}

ShellField::ShellField(std::shared_ptr<const VotfVolume> volume) : volume_(std::move(volume)) {
  const VotfVolume& v = *volume_;
  const size_t row = (size_t{v.width} + 1) * v.depth;
  column_.resize((size_t{v.height} + 1) * row + sizeof(int32_t));
  for (size_t y = 0; y <= v.height; ++y) {
    for (size_t x = 0; x <= v.width; ++x) {
      const size_t from = (y % v.height) * v.width + x % v.width;
      for (size_t z = 0; z < v.depth; ++z) {
        column_[y * row + x * v.depth + z] = v.distance[z * v.height * v.width + from];
      }
    }
  }
  table_ = {.column = column_.data(),
            .width = v.width,
            .height = v.height,
            .depth = v.depth,
            .row = static_cast<uint32_t>(row),
            .bottom = v.bottom,
            .top = v.top,
            .pitch = v.pitch(),
            .per_step = 1.0f / v.step(),
            .per_aspect = 1.0f / v.aspect,
            .unit = v.reach / VotfVolume::kUnits};
}

float ShellField::distance(const Vec3& q) const {
  float found;
  shell_distances(table_, {&q, 1}, &found);
  return found;
}

Vec3 ShellField::gradient(const Vec3& q) const {
  const float h = 0.5f * table_.pitch;
  const Vec3 x(h, 0, 0), y(0, h, 0), z(0, 0, h), around[] = {q + x, q - x, q + y, q - y, q + z, q - z};
  float d[6];
  shell_distances(table_, around, d);
  return Vec3(d[0] - d[1], d[2] - d[3], d[4] - d[5]) / (2 * h);
}

Vec3 check_view(uint64_t seed, uint32_t i) {
  RandomStream numbers(seed, i, 0);
  const float cosine = 1 - numbers.next() * (1 - std::cos(radians_from(75.0f)));
  return direction(std::acos(cosine), 2 * kPi * numbers.next());
}

std::vector<uint8_t> visibility_mask(const ShellField& field, const TileTexels& texels, const Vec3& wv) {
  std::vector<Vec2> places(texels.size());
  for (size_t i = 0; i < places.size(); ++i) places[i] = texels.center(i);
  std::vector<uint8_t> mask(places.size());
  lines_meet(field, places, wv, mask.data());
  return mask;
}

}  // namespace velour

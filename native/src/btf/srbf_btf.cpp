#include "btf/srbf_btf.h"

#include <cmath>

namespace velour {

uint64_t SrbfSide::parameter_bytes() const {
  uint64_t bytes = lobes.size() * sizeof(MultivariateLobe) + coefficients() * sizeof(uint16_t);
  for (const SrbfLevel& level : levels) bytes += (level.value.size() + level.relief.size()) * sizeof(HalfBits);
  return bytes;
}

uint64_t SrbfBtf::parameter_bytes() const {
  uint64_t bytes = 0;
  for (const SrbfSide& side : sides) bytes += side.parameter_bytes();
  return bytes;
}

float tile_aspect(const TexelGrid& grid) {
  if (grid.tile_metres) return grid.tile_metres->y / grid.tile_metres->x;
  return static_cast<float>(grid.height) / static_cast<float>(grid.width);
}

Mat3 to_normal(const Vec3& normal) {
  // Rodrigues' formula about (n.y, -n.x, 0), whose length is the sine.
  const float a = 1 / (1 + normal.z);
  const float xy = -a * normal.x * normal.y;
  return {Vec3(1 - a * normal.x * normal.x, xy, normal.x), Vec3(xy, 1 - a * normal.y * normal.y, normal.y),
          Vec3(-normal.x, -normal.y, normal.z)};
}

}  // namespace velour

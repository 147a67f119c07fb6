#include "btf/model/srbf_btf.h"

#include <algorithm>
#include <cmath>

namespace velour {

uint8_t ByteScale::nearest(float value) const {
  const float steps = step > 0 ? (value - least) / step : 0.0f;
  return static_cast<uint8_t>(std::lround(std::clamp(steps, 0.0f, 255.0f)));
}

void SrbfSide::set_scale(const std::vector<std::vector<float>>& values) {
  const size_t count = coefficients();
  scale.assign(count, {});
  for (size_t k = 0; k < count; ++k) {
    float least = values[0][k], most = least;
    for (const std::vector<float>& level : values) {
      for (size_t i = k; i < level.size(); i += count) {
        least = std::min(least, level[i]);
        most = std::max(most, level[i]);
      }
    }
    scale[k] = {least, (most - least) / 255};
  }
}

void SrbfSide::set_values(const std::vector<std::vector<float>>& values) {
  for (size_t l = 0; l < levels.size(); ++l) {
    levels[l].value.resize(values[l].size());
    for (size_t i = 0; i < values[l].size(); ++i) levels[l].value[i] = scale[i % scale.size()].nearest(values[l][i]);
  }
}

uint64_t SrbfSide::parameter_bytes() const {
  uint64_t bytes = lobes.size() * sizeof(MultivariateLobe) + coefficients() * (sizeof(uint16_t) + sizeof(ByteScale));
  for (const SrbfLevel& level : levels) bytes += level.value.size() + level.relief.size() * sizeof(HalfBits);
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

}  // namespace velour

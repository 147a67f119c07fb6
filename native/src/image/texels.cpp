#include "image/texels.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

/// Weights of the fine texels in a coarse one along an axis.
struct Taps {
  uint32_t first = 0;
  std::vector<float> weight;
};

std::vector<Taps> taps_of(uint32_t fine) {
  const uint32_t coarse = half_of(fine);
  const double step = static_cast<double>(fine) / coarse;
  std::vector<Taps> taps(coarse);
  for (uint32_t i = 0; i < coarse; ++i) {
    const double begin = step * i, end = step * (i + 1);
    taps[i].first = static_cast<uint32_t>(begin);
    for (uint32_t j = taps[i].first; j < fine && j < end; ++j) {
      const double share = std::min<double>(end, j + 1.0) - std::max<double>(begin, j);
      if (share > 1e-9) taps[i].weight.push_back(static_cast<float>(share / step));
    }
  }
  return taps;
}

}  // namespace

std::vector<float> half_image(std::span<const float> image, uint32_t width, uint32_t height, uint32_t channels) {
  const std::vector<Taps> columns = taps_of(width), rows = taps_of(height);
  std::vector<float> out(columns.size() * rows.size() * channels, 0.0f);
  float* to = out.data();
  for (const Taps& row : rows) {
    for (const Taps& column : columns) {
      for (size_t j = 0; j < row.weight.size(); ++j) {
        for (size_t i = 0; i < column.weight.size(); ++i) {
          const float weight = row.weight[j] * column.weight[i];
          const float* from = image.data() + ((row.first + j) * width + column.first + i) * channels;
          for (uint32_t c = 0; c < channels; ++c) to[c] += weight * from[c];
        }
      }
      to += channels;
    }
  }
  return out;
}

}  // namespace velour

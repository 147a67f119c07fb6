#include "compress/lobe_values.h"

#include <algorithm>

#include "srbf/aligned_array.h"

namespace velour {
RowMatrix LobeValues::at(const SurfacePoint& point, size_t pairs) const {
  const size_t count = std::min(pairs, point.pair.size());
  RowMatrix values(static_cast<Eigen::Index>(count), tile_.size() + texel_.size());
  AlignedArray<float> row(std::max(tile_.padded(), texel_.padded()));
  for (size_t i = 0; i < count; ++i) {
    float* const to = values.row(static_cast<Eigen::Index>(i)).data();
    tile_.values(point.pair[i], row.data());
    std::copy_n(row.data(), tile_.size(), to);
    texel_.values(point.pair[i].turned(point.to_normal), row.data());
    std::copy_n(row.data(), texel_.size(), to + tile_.size());
  }
  return values;
}

}  // namespace velour

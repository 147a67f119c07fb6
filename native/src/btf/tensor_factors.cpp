#include "btf/tensor_factors.h"

namespace velour {
namespace {

std::vector<float> floats_of(const std::vector<HalfBits>& halves) {
  std::vector<float> floats(halves.size());
  halves_to_floats(halves, floats);
  return floats;
}

/// Converts [axis][rank] to [channel][rank].
std::vector<float> in_rgb(const std::vector<float>& along_axes, const Mat3& axes) {
  std::vector<float> rgb(along_axes.size(), 0.0f);
  const size_t rank = rgb.size() / 3;
  for (size_t k = 0; k < rank; ++k) {
    const Vec3 color = axes * Vec3(along_axes[k], along_axes[rank + k], along_axes[2 * rank + k]);
    for (size_t c = 0; c < 3; ++c) rgb[c * rank + k] = color[static_cast<int>(c)];
  }
  return rgb;
}

}  // namespace

TensorFactors::TensorFactors(const TensorBtf& btf, const TensorBtfCluster& cluster)
    : view(floats_of(cluster.view)),
      light(floats_of(cluster.light)),
      color(in_rgb(floats_of(cluster.color), btf.axes)),
      core(floats_of(cluster.core)) {}

std::vector<float> heights_of(const TensorLevel& level) { return floats_of(level.relief); }

}  // namespace velour

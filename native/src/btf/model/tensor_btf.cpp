#include "btf/model/tensor_btf.h"

namespace velour {

TensorBytes bytes_of(const TensorSide& side) {
  TensorBytes sum;
  for (const TensorBtfCluster& c : side.clusters) {
    sum.factors += (c.view.size() + c.light.size() + c.color.size()) * sizeof(HalfBits);
    sum.cores += c.core.size() * sizeof(HalfBits);
    sum.scales += c.scale.size() * sizeof(ByteScale);
  }
  for (const TensorLevel& level : side.levels) {
    sum.coefficients += level.value.size();
    sum.members += level.member.size();
    sum.relief += level.relief.size() * sizeof(HalfBits);
  }
  return sum;
}

uint64_t TensorSide::parameter_bytes() const {
  const TensorBytes sum = bytes_of(*this);
  return sum.coefficients + sum.members + sum.relief + sum.factors + sum.cores + sum.scales;
}

uint64_t TensorBtf::parameter_bytes() const {
  uint64_t bytes = 0;
  for (const TensorSide& side : sides) bytes += side.parameter_bytes();
  return bytes;
}

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

#include "btf/tensor_bytes.h"

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

}  // namespace velour

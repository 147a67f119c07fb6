#include "btf/tensor_btf.h"

namespace velour {

uint64_t TensorSide::parameter_bytes() const {
  uint64_t bytes = 0;
  for (const TensorBtfCluster& c : clusters) {
    bytes += (c.view.size() + c.light.size() + c.color.size() + c.core.size()) * sizeof(HalfBits) +
             c.scale.size() * sizeof(ByteScale);
  }
  for (const TensorLevel& level : levels) {
    bytes += level.relief.size() * sizeof(HalfBits) + level.member.size() + level.value.size();
  }
  return bytes;
}

uint64_t TensorBtf::parameter_bytes() const {
  uint64_t bytes = 0;
  for (const TensorSide& side : sides) bytes += side.parameter_bytes();
  return bytes;
}

}  // namespace velour

// A point of an SRBF BTF seen from one view.
#pragma once

#include <cstdint>

#include "btf/byte_rows.h"
#include "btf/srbf_btf.h"

namespace velour {

/// Scratch memory of SrbfEvaluator, reused from hit to hit. Directions are in the frame of the side, z > 0.
struct SrbfPoint {
  static constexpr uint32_t kMostRecord = 3 * SrbfBtf::kMaxLobes + 3 * kByteRowPadding;

  alignas(64) float record[kMostRecord];  // interpolated texel record, see SrbfEvaluator
  Vec3 wv;
  Mat3 to_normal;
  uint32_t side;
  bool seen;  // set by the caller; false where the BTF was not fitted
};

}  // namespace velour

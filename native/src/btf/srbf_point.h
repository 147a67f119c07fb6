// A place of a BTF of multivariate SRBFs and a view of it.
#pragma once

#include <cstdint>

#include "btf/byte_rows.h"
#include "btf/srbf_btf.h"

namespace velour {

/// Scratch memory of SrbfEvaluator, reused from hit to hit. Directions are those of the side, z > 0.
struct SrbfPoint {
  static constexpr uint32_t kMostRecord = 3 * SrbfBtf::kMaxLobes + 3 * kByteRowPadding;

  alignas(64) float record[kMostRecord];  // blended over texels: see SrbfEvaluator
  Vec3 wv;
  Mat3 to_normal;
  uint32_t side;
  bool seen;  // whoever looks sets it: false where the BTF was not fitted
};

}  // namespace velour

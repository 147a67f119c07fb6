#include "brdf/fit/parametric/warped_columns.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/fit/parametric/residual_sums.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// Requires Highway's namespace of the target.
#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// kPadding interleaved sums over a block. Without fused multiply-adds, so the bits are the same on every machine.
void AddSquares(const float* residual, const float* share, size_t count, float* all, float* shared) {
  const hn::CappedTag<float, SliceSamples::kPadding> tag;
  for (size_t lane = 0; lane < SliceSamples::kPadding; lane += hn::Lanes(tag)) {
    auto every = hn::Zero(tag), part = every;
    for (size_t i = lane; i < count; i += SliceSamples::kPadding) {
      const auto r = hn::Load(tag, residual + i), square = hn::Mul(r, r);
      every = hn::Add(every, square);
      part = hn::Add(part, hn::Mul(square, hn::Load(tag, share + i)));
    }
    hn::StoreU(every, tag, all + lane);
    hn::StoreU(part, tag, shared + lane);
  }
}

}  // namespace velour::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

namespace {
HWY_EXPORT(AddSquares);
constexpr size_t kBlock = 256;
}  // namespace

ResidualSums residual_sums(const AlignedFloats& residual, const AlignedFloats& share) {
  ResidualSums sums;
  for (size_t begin = 0; begin < residual.size(); begin += kBlock) {
    float all[SliceSamples::kPadding], shared[SliceSamples::kPadding];
    VELOUR_SIMD_DISPATCH(AddSquares)
    (residual.data() + begin, share.data() + begin, std::min(kBlock, residual.size() - begin), all, shared);
    for (const float s : all) sums.all += static_cast<double>(s);
    for (const float s : shared) sums.shared += static_cast<double>(s);
  }
  return sums;
}

}  // namespace velour
#endif  // HWY_ONCE

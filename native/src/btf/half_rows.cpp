// Highway compiles this file once for each instruction set.
#include "btf/half_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "btf/half_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "srbf/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void add_rows(const std::array<WeightedHalves, 4>& rows, uint32_t count, float* to) {
  const hn::CappedTag<float, kHalfRowPadding> d;
  const hn::Rebind<HalfBits, decltype(d)> du;
  const hn::Rebind<hwy::float16_t, decltype(d)> dh;
  const auto row = [&](size_t i, uint32_t k) {
    return hn::PromoteTo(d, hn::BitCast(dh, hn::LoadU(du, rows[i].row + k)));
  };
  for (uint32_t k = 0; k < count; k += static_cast<uint32_t>(hn::Lanes(d))) {
    const auto left = hn::MulAdd(row(0, k), hn::Set(d, rows[0].weight),
                                 hn::MulAdd(row(1, k), hn::Set(d, rows[1].weight), hn::Load(d, to + k)));
    const auto right =
        hn::MulAdd(row(2, k), hn::Set(d, rows[2].weight), hn::Mul(row(3, k), hn::Set(d, rows[3].weight)));
    hn::Store(hn::Add(left, right), d, to + k);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(add_rows);

void add_half_rows(const std::array<WeightedHalves, 4>& rows, uint32_t count, float* to) {
  VELOUR_SIMD_DISPATCH(add_rows)(rows, count, to);
}

}  // namespace velour
#endif

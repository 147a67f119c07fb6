// Highway compiles this file once for each instruction set.
#include "btf/fit/srbf/texel_solver.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "btf/fit/srbf/row_products.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, 16>;

void rows_by_vectors(const float* rows, uint32_t count, uint32_t stride, const float* coefficient, float* value) {
  const Lanes d;
  const auto step = static_cast<uint32_t>(hn::Lanes(d));
  for (uint32_t i = 0; i < count; ++i, rows += stride, value += 3) {
    auto x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    for (uint32_t k = 0; k < stride; k += step) {
      const auto row = hn::Load(d, rows + k);
      x = hn::MulAdd(row, hn::Load(d, coefficient + k), x);
      y = hn::MulAdd(row, hn::Load(d, coefficient + stride + k), y);
      z = hn::MulAdd(row, hn::Load(d, coefficient + 2 * stride + k), z);
    }
    value[0] = hn::GetLane(hn::SumOfLanes(d, x));
    value[1] = hn::GetLane(hn::SumOfLanes(d, y));
    value[2] = hn::GetLane(hn::SumOfLanes(d, z));
  }
}

void vectors_by_rows(const float* rows, uint32_t count, uint32_t stride, const float* value, float* sum) {
  const Lanes d;
  for (uint32_t k = 0; k < stride; k += static_cast<uint32_t>(hn::Lanes(d))) {
    auto x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
    const float* row = rows + k;
    for (uint32_t i = 0; i < count; ++i, row += stride) {
      const auto v = hn::Load(d, row);
      x = hn::MulAdd(v, hn::Set(d, value[3 * i]), x);
      y = hn::MulAdd(v, hn::Set(d, value[3 * i + 1]), y);
      z = hn::MulAdd(v, hn::Set(d, value[3 * i + 2]), z);
    }
    hn::Store(x, d, sum + k);
    hn::Store(y, d, sum + stride + k);
    hn::Store(z, d, sum + 2 * stride + k);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(rows_by_vectors);
HWY_EXPORT(vectors_by_rows);

void rows_times(const float* rows, uint32_t count, uint32_t stride, const float* coefficient, float* value) {
  VELOUR_SIMD_DISPATCH(rows_by_vectors)(rows, count, stride, coefficient, value);
}

void times_rows(const float* rows, uint32_t count, uint32_t stride, const float* value, float* sum) {
  VELOUR_SIMD_DISPATCH(vectors_by_rows)(rows, count, stride, value, sum);
}

}  // namespace velour
#endif

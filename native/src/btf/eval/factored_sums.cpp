// Highway compiles this file once for each instruction set.
#include "btf/eval/factored_material.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "btf/eval/factored_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, kFactoredSlack>;
using Lanes = hn::Vec<Tag>;

/// Products of kRows rows with the values, summed by lane and weighted. Several rows at once: their sums do not wait
/// for each other, and each vector of values is loaded once.
template <size_t kRows>
HWY_INLINE Lanes weighted_products(const float* value, const WeightedRow* rows, uint32_t count) {
  const Tag d;
  const auto lanes = static_cast<uint32_t>(hn::Lanes(d));
  Lanes sum[kRows];
  for (size_t r = 0; r < kRows; ++r) sum[r] = hn::Zero(d);
  uint32_t k = 0;
  for (; k + lanes <= count; k += lanes) {
    const Lanes v = hn::LoadU(d, value + k);
    for (size_t r = 0; r < kRows; ++r) sum[r] = hn::MulAdd(v, hn::LoadU(d, rows[r].row + k), sum[r]);
  }
  if (k < count) {
    const auto inside = hn::FirstN(d, count - k);
    const Lanes v = hn::IfThenElseZero(inside, hn::LoadU(d, value + k));
    for (size_t r = 0; r < kRows; ++r) {
      sum[r] = hn::MulAdd(v, hn::IfThenElseZero(inside, hn::LoadU(d, rows[r].row + k)), sum[r]);
    }
  }
  Lanes weighted = hn::Mul(sum[0], hn::Set(d, rows[0].weight));
  for (size_t r = 1; r < kRows; ++r) weighted = hn::MulAdd(sum[r], hn::Set(d, rows[r].weight), weighted);
  return weighted;
}

float weighted_dot_simd(const float* value, const WeightedRow* rows, size_t row_count, uint32_t count) {
  const Tag d;
  Lanes sum = hn::Zero(d);
  size_t r = 0;
  for (; r + 3 <= row_count; r += 3) sum = hn::Add(sum, weighted_products<3>(value, rows + r, count));
  for (; r < row_count; ++r) sum = hn::Add(sum, weighted_products<1>(value, rows + r, count));
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

void add_weighted_simd(const float* HWY_RESTRICT row, float weight, uint32_t count, float* HWY_RESTRICT sum) {
  const Tag d;
  const auto lanes = static_cast<uint32_t>(hn::Lanes(d));
  const Lanes w = hn::Set(d, weight);
  uint32_t k = 0;
  for (; k + lanes <= count; k += lanes) {
    hn::StoreU(hn::MulAdd(w, hn::LoadU(d, row + k), hn::LoadU(d, sum + k)), d, sum + k);
  }
  for (; k < count; ++k) sum[k] += weight * row[k];
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(weighted_dot_simd);
HWY_EXPORT(add_weighted_simd);

float weighted_dot(const float* value, std::span<const WeightedRow> rows, uint32_t count) {
  return VELOUR_SIMD_DISPATCH(weighted_dot_simd)(value, rows.data(), rows.size(), count);
}

void add_weighted(const WeightedRow& row, uint32_t count, float* sum) {
  VELOUR_SIMD_DISPATCH(add_weighted_simd)(row.row, row.weight, count, sum);
}

}  // namespace velour
#endif

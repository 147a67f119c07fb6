// Highway compiles this file once for each instruction set.
#include "material/factored_sums.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "material/factored_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "srbf/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The outer loop runs over rows and the inner one over components, so each row is read once, sequentially.
float sum_of_range(const float* value, const WeightedRow* rows, size_t count, uint32_t begin, uint32_t end) {
  const hn::CappedTag<float, kFactoredPadding> d;
  auto sum = hn::Zero(d);
  for (size_t r = 0; r < count; ++r) {
    auto of_row = hn::Zero(d);
    for (uint32_t k = begin; k < end; k += static_cast<uint32_t>(hn::Lanes(d))) {
      of_row = hn::MulAdd(hn::Load(d, value + k), hn::LoadU(d, rows[r].row + k), of_row);
    }
    sum = hn::MulAdd(of_row, hn::Set(d, rows[r].weight), sum);
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(sum_of_range);

Vec3 factored_sums(const float* value, std::span<const WeightedRow> rows, const std::array<uint32_t, 3>& end) {
  const auto sum = VELOUR_SIMD_DISPATCH(sum_of_range);
  return {sum(value, rows.data(), rows.size(), 0, end[0]), sum(value, rows.data(), rows.size(), end[0], end[1]),
          sum(value, rows.data(), rows.size(), end[1], end[2])};
}

}  // namespace velour
#endif

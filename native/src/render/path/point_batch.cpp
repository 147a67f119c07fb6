// Highway compiles this file once for each instruction set.
#include "render/path/path_numbers.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/path/point_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Vectorized versions of the functions that math/sphere/random.cpp explains.

template <int kBits, class D, class V = hn::Vec<D>>
HWY_INLINE V swap_neighbors(D d, V x, uint32_t low) {
  const V mask = hn::Set(d, low);
  return hn::Or(hn::And(hn::ShiftRight<kBits>(x), mask), hn::ShiftLeft<kBits>(hn::And(x, mask)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V reversed(D d, V x) {
  x = swap_neighbors<1>(d, x, 0x55555555u);
  x = swap_neighbors<2>(d, x, 0x33333333u);
  x = swap_neighbors<4>(d, x, 0x0f0f0f0fu);
  x = swap_neighbors<8>(d, x, 0x00ff00ffu);
  return hn::RotateRight<16>(x);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V carry_upwards(D d, V x, V seed) {
  x = hn::Add(x, seed);
  for (const uint32_t factor : kOwenFactors) x = hn::Xor(x, hn::Mul(x, hn::Set(d, factor)));
  return x;
}

template <int kBits, class D, class V = hn::Vec<D>>
HWY_INLINE V butterfly(D d, V x, uint32_t high) {
  return hn::Xor(x, hn::ShiftRight<kBits>(hn::And(x, hn::Set(d, high))));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V pascal(D d, V x) {
  x = butterfly<1>(d, x, 0xaaaaaaaau);
  x = butterfly<2>(d, x, 0xccccccccu);
  x = butterfly<4>(d, x, 0xf0f0f0f0u);
  x = butterfly<8>(d, x, 0xff00ff00u);
  return hn::Xor(x, hn::ShiftRight<16>(x));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE auto unit(D, V bits) {
  const hn::RebindToFloat<D> df;
  const hn::RebindToSigned<D> di;
  return hn::Mul(hn::ConvertTo(df, hn::BitCast(di, hn::ShiftRight<8>(bits))), hn::Set(df, 0x1p-24f));
}

void points_simd(const PointBatch::Lanes& lanes) {
  const hn::CappedTag<uint32_t, 16> d;
  const hn::RebindToFloat<decltype(d)> df;
  for (int at = 0; at < lanes.count; at += static_cast<int>(hn::Lanes(d))) {
    const auto index = reversed(d, hn::Load(d, lanes.index + at));
    const auto shuffled = reversed(d, carry_upwards(d, index, hn::Load(d, lanes.order + at)));
    const auto x = reversed(d, carry_upwards(d, shuffled, hn::Load(d, lanes.seed_x + at)));
    const auto y = reversed(d, carry_upwards(d, pascal(d, shuffled), hn::Load(d, lanes.seed_y + at)));
    hn::StoreInterleaved2(unit(d, x), unit(d, y), df, lanes.points + 2 * at);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(points_simd);

void PointBatch::resolve() {
  if (pending_) VELOUR_SIMD_DISPATCH(points_simd)({index_, order_, seed_x_, seed_y_, &points_[0].x, count_});
  pending_ = false;
}

}  // namespace velour
#endif

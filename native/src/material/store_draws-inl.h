// The density's part of a warped mixture. Included once for each instruction set, by sources that Highway compiles so.
#if defined(VELOUR_MATERIAL_STORE_DRAWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VELOUR_MATERIAL_STORE_DRAWS_INL_H_
#undef VELOUR_MATERIAL_STORE_DRAWS_INL_H_
#else
#define VELOUR_MATERIAL_STORE_DRAWS_INL_H_
#endif

#include <hwy/highway.h>

#include "srbf/draw_math-inl.h"
#include "srbf/kernel.h"
#include "srbf/warped_mixture.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Lobes of the density from `at` on, whatever their centres' lengths. `below` and `up_to` are the running sums on both
/// sides of each lobe: their difference, rounded the same way, is the probability of the draws.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_draws(D d, const Vector<V>& center, V bandwidth, V below, V up_to, int at, WarpedMixture& m) {
  const V scale =
      reciprocal_sqrt(d, hn::MulAdd(center.x, center.x, hn::MulAdd(center.y, center.y, hn::Mul(center.z, center.z))));
  hn::Store(hn::Mul(scale, center.x), d, m.draw_x + at);
  hn::Store(hn::Mul(scale, center.y), d, m.draw_y + at);
  hn::Store(hn::Mul(scale, center.z), d, m.draw_z + at);
  bandwidth = hn::Max(bandwidth, hn::Set(d, static_cast<float>(kMinMeanBandwidth)));
  const V tail = exp_nonpositive(d, hn::Mul(hn::Set(d, -2.0f), bandwidth));
  hn::Store(bandwidth, d, m.draw_bandwidth + at);
  hn::Store(tail, d, m.draw_tail + at);
  hn::Store(up_to, d, m.sums + m.kSums + at);
  if (at == 0) {
    m.sums[m.kSums - 2] = 0;
    m.sums[m.kSums - 1] = hn::GetLane(below);
  }
  // The integral of the kernel, 2 pi (1 - e^-2l) / l; no smaller l than the least, so the difference is exact enough.
  const V scaled = hn::Mul(hn::Mul(hn::Set(d, 0.5f / kPi), hn::Sub(up_to, below)), bandwidth);
  hn::Store(hn::Div(scaled, hn::Sub(hn::Set(d, 1.0f), tail)), d, m.density + at);
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#endif

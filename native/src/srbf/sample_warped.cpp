// Highway compiles this file once for each instruction set.
#include <algorithm>
#include <cassert>

#include "sphere/discrete_choice.h"
#include "srbf/lobe_draws.h"
#include "srbf/unwarps.h"
#include "srbf/warped_mixture.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "srbf/sample_warped.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "srbf/simd_dispatch.h"
#include "srbf/simd_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// psi, in `w`, becomes wl: eta = normalize(S^-1 psi), in half space mirrored. Lanes past the count hold anything.
template <class D>
HWY_INLINE void unwarp(D d, const WarpedMixture& m, const Unwarps& how, DirectionBatch& w) {
  using V = hn::Vec<D>;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  const V vx = hn::Set(d, m.wv.x), vy = hn::Set(d, m.wv.y), vz = hn::Set(d, m.wv.z);
  const V c = hn::Set(d, m.turn_cos), s = hn::Set(d, m.turn_sin);
  for (int at = 0; at < w.count; at += static_cast<int>(hn::Lanes(d))) {
    const V px = hn::Load(d, w.x + at), py = hn::Load(d, w.y + at), pz = hn::Load(d, w.z + at);
    const V s_xy = hn::Load(d, how.s_xy + at);
    const V qx = hn::NegMulAdd(s_xy, py, hn::Mul(hn::Load(d, how.s_yy + at), px));  // S^-1 of determinant 1
    const V qy = hn::NegMulAdd(s_xy, px, hn::Mul(hn::Load(d, how.s_xx + at), py));
    const V inverse = hn::Div(one, hn::Sqrt(hn::MulAdd(qx, qx, hn::MulAdd(qy, qy, hn::Mul(pz, pz)))));
    const V ex = hn::Mul(qx, inverse), ey = hn::Mul(qy, inverse), ez = hn::Mul(pz, inverse);
    // wl = 2 (eta . wv) eta - wv in half space, eta in light space.
    const V cosine = hn::MulAdd(ex, vx, hn::MulAdd(ey, vy, hn::Mul(ez, vz)));
    const V half = hn::Load(d, how.half + at);
    const V stride = hn::MulAdd(half, hn::MulSub(hn::Set(d, 2.0f), cosine, one), one);
    const V x = hn::NegMulAdd(half, vx, hn::Mul(stride, ex)), y = hn::NegMulAdd(half, vy, hn::Mul(stride, ey));
    const V z = hn::NegMulAdd(half, vz, hn::Mul(stride, ez));
    const auto lost = hn::And(hn::Gt(half, zero), hn::Le(cosine, zero));
    hn::Store(hn::IfThenZeroElse(lost, hn::NegMulAdd(s, y, hn::Mul(c, x))), d, w.x + at);
    hn::Store(hn::IfThenZeroElse(lost, hn::MulAdd(s, x, hn::Mul(c, y))), d, w.y + at);
    hn::Store(hn::IfThenElse(lost, hn::Neg(one), z), d, w.z + at);
  }
}

/// A single draw has no vector to wait for.
void unwarp_simd(const WarpedMixture& m, const Unwarps& how, DirectionBatch& w) {
  if (w.count == 1) return unwarp(hn::CappedTag<float, 1>(), m, how, w);
  return unwarp(hn::CappedTag<float, 8>(), m, how, w);
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(unwarp_simd);

void sample_warped(const WarpedMixture& m, std::span<const Vec2> u, DirectionBatch& wl) {
  assert(u.size() <= DirectionBatch::kCapacity);
  LobeDraws draws;
  Unwarps how;
  for (const Vec2& number : u) {
    const int at = draws.count;
    double left = middle_of_step(number.x);
    const int chosen = choose_index(m.cdf, m.count + 1, left);
    // The first component is the cosine. Without a branch: which one it is cannot be predicted.
    const int j = std::max(chosen - 1, 0);
    const auto pick = [is_lobe = chosen > 0](float cosine, float lobe) {
      const float both[2] = {cosine, lobe};
      return both[is_lobe];
    };
    const Vec3 axis(pick(0, m.draw_x[j]), pick(0, m.draw_y[j]), pick(1, m.draw_z[j]));
    draws.push(axis, pick(LobeDraws::kCosine, m.draw_bandwidth[j]), std::min(left, 1 - 0x1p-24), number.y);
    how.set(at, pick(0, m.half[j]), pick(1, m.s_xx[j]), pick(0, m.s_xy[j]), pick(1, m.s_yy[j]));
  }
  draws.directions(Kernel::gaussian, wl);
  VELOUR_SIMD_DISPATCH(unwarp_simd)(m, how, wl);
}

}  // namespace velour
#endif

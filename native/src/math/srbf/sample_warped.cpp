// Highway compiles this file once for each instruction set.
#include <algorithm>
#include <cassert>

#include "math/srbf/warped_mixture.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/srbf/sample_warped.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "math/srbf/draw_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Index of the component, where 0 is the cosine: the number of running sums that are at most u, in [0, 1).
template <class D>
HWY_INLINE int component_of(D d, const WarpedMixture& m, float u) {
  int component = m.cosine() <= u;
  for (int at = 0; at < m.padded; at += static_cast<int>(hn::Lanes(d))) {
    component += static_cast<int>(hn::CountTrue(d, hn::Le(hn::Load(d, m.sums + m.kSums + at), hn::Set(d, u))));
  }
  return component;
}

HWY_INLINE void choose(const WarpedMixture& m, const Vec2& u, WarpedDraws& draws) {
  const int passed = m.padded % 16 == 0 ? component_of(hn::CappedTag<float, 16>(), m, u.x)
                                        : component_of(hn::CappedTag<float, 8>(), m, u.x);
  const int component = std::min(passed, m.count);  // the last sum may be rounded to less than 1
  // u + 2^-25, the middle of its step, lies between two sums; both differences are precise.
  const float below = m.sums[m.kSums - 2 + component], up_to = m.sums[m.kSums - 1 + component];
  const float scale = 1 / (up_to - below);
  const float left = std::clamp((u.x - below + 0x1p-25f) * scale, 0.0f, 1 - 0x1p-24f);
  const float rest = std::clamp((up_to - u.x - 0x1p-25f) * scale, 0x1p-24f, 1.0f);
  draws.push(m, component - 1, left, rest, u.y);
}

/// psi of the samples at `at`, in their parameterizations.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector<V> psi_of(D d, const WarpedDraws& draws, int at) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), two = hn::Set(d, 2.0f);
  const V bandwidth = hn::Load(d, draws.bandwidth + at), tail = hn::Load(d, draws.tail + at);
  const V u = hn::Load(d, draws.u + at), rest = hn::Load(d, draws.rest + at);
  const V from_axis = gaussian_zenith(d, bandwidth, tail, hn::Sub(one, tail), u, rest);
  const V lobe_d = hn::Min(hn::Max(from_axis, zero), two);
  const auto is_cosine = hn::Lt(bandwidth, zero);
  const V sine = hn::Sqrt(hn::IfThenElse(is_cosine, u, hn::Mul(lobe_d, hn::Sub(two, lobe_d))));
  const V z = hn::IfThenElse(is_cosine, hn::Sqrt(rest), hn::Sub(one, lobe_d));
  const Vector<V> axis{hn::Load(d, draws.x + at), hn::Load(d, draws.y + at), hn::Load(d, draws.z + at)};
  return about_axis(d, axis, sine, z, hn::Load(d, draws.azimuth + at));
}

/// wl of psi: eta = normalize(S^-1 psi), about which half space reflects wv; -z if there is no direction.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector<V> unwarped(D d, const WarpedMixture& m, const WarpedDraws& draws, int at, const Vector<V>& psi) {
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f), s_xy = hn::Load(d, draws.s_xy + at);
  const V qx = hn::NegMulAdd(s_xy, psi.y, hn::Mul(hn::Load(d, draws.s_yy + at), psi.x));  // S^-1 of determinant 1
  const V qy = hn::NegMulAdd(s_xy, psi.x, hn::Mul(hn::Load(d, draws.s_xx + at), psi.y));
  const V length_sq = hn::MulAdd(qx, qx, hn::MulAdd(qy, qy, hn::Mul(psi.z, psi.z)));
  const V inverse = reciprocal_sqrt(d, length_sq);
  const V ex = hn::Mul(qx, inverse), ey = hn::Mul(qy, inverse), ez = hn::Mul(psi.z, inverse);
  // wl = 2 (eta . wv) eta - wv in half space, eta in light space.
  const V vx = hn::Set(d, m.wv.x), vy = hn::Set(d, m.wv.y), vz = hn::Set(d, m.wv.z);
  const V cosine = hn::MulAdd(ex, vx, hn::MulAdd(ey, vy, hn::Mul(ez, vz)));
  const V half = hn::Load(d, draws.half + at);
  const V stride = hn::MulAdd(half, hn::MulSub(hn::Set(d, 2.0f), cosine, one), one);
  const V x = hn::NegMulAdd(half, vx, hn::Mul(stride, ex)), y = hn::NegMulAdd(half, vy, hn::Mul(stride, ey));
  const V z = hn::NegMulAdd(half, vz, hn::Mul(stride, ez));
  const auto lost = hn::And(hn::Gt(half, zero), hn::Le(cosine, zero));
  const V c = hn::Set(d, m.turn_cos), s = hn::Set(d, m.turn_sin);
  return {hn::IfThenZeroElse(lost, hn::NegMulAdd(s, y, hn::Mul(c, x))),
          hn::IfThenZeroElse(lost, hn::MulAdd(s, x, hn::Mul(c, y))), hn::IfThenElse(lost, hn::Neg(one), z)};
}

/// A single sample uses scalars, which have lower latency.
Vec3 sample_one_simd(const WarpedMixture& m, const Vec2& u) {
  const hn::CappedTag<float, 1> d;
  WarpedDraws draws;
  choose(m, u, draws);
  const auto w = unwarped(d, m, draws, 0, psi_of(d, draws, 0));
  return {hn::GetLane(w.x), hn::GetLane(w.y), hn::GetLane(w.z)};
}

void sample_batch_simd(const WarpedMixture& m, std::span<const Vec2> u, DirectionBatch& wl) {
  if (u.size() == 1) {
    wl.count = 1;
    return wl.set(0, sample_one_simd(m, u[0]));
  }
  const hn::CappedTag<float, 8> d;
  WarpedDraws draws;
  for (const Vec2& number : u) choose(m, number, draws);
  wl.count = draws.count;
  while (draws.count % 8 != 0) draws.push(m, -1, 0.5f, 0.5f, 0.0f);
  for (int at = 0; at < draws.count; at += static_cast<int>(hn::Lanes(d))) {
    const auto w = unwarped(d, m, draws, at, psi_of(d, draws, at));
    hn::Store(w.x, d, wl.x + at);
    hn::Store(w.y, d, wl.y + at);
    hn::Store(w.z, d, wl.z + at);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(sample_batch_simd);
HWY_EXPORT(sample_one_simd);

void sample_warped(const WarpedMixture& mixture, std::span<const Vec2> u, DirectionBatch& wl) {
  assert(u.size() <= DirectionBatch::kCapacity);
  VELOUR_SIMD_DISPATCH(sample_batch_simd)(mixture, u, wl);
}

Vec3 sample_warped(const WarpedMixture& mixture, const Vec2& u) {
  return VELOUR_SIMD_DISPATCH(sample_one_simd)(mixture, u);
}

}  // namespace velour
#endif

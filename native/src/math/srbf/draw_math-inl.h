// SIMD sampling of lobes. Included once per instruction set by sources that use foreach_target.h.
#if defined(VELOUR_SRBF_DRAW_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VELOUR_SRBF_DRAW_MATH_INL_H_
#undef VELOUR_SRBF_DRAW_MATH_INL_H_
#else
#define VELOUR_SRBF_DRAW_MATH_INL_H_
#endif

#include <hwy/highway.h>

#include "math/sphere/simd_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class V>
struct Vector {
  V x, y, z;
};

/// d = 1 - cos of the zenith about the center of a Gaussian (kernel_sample in float): -log(u + rest e^-2l) / l. `u` and
/// `rest` = 1 - u both have full precision; so do `tail` = e^-2l and `whole` = 1 - tail.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V gaussian_zenith(D d, V bandwidth, V tail, V whole, V u, V rest) {
  // The latency of the logarithm hides that of the division.
  const V width_sq = hn::Div(hn::Set(d, 1.0f), bandwidth);
  return hn::Mul(minus_log(d, hn::MulAdd(rest, tail, u), hn::Mul(rest, whole)), width_sq);
}

/// Sine and cosine of 2 pi a, a in [0, 1), absolute errors below 1.2e-7: Taylor series about the nearest quarter turn.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void sin_cos_of_turns(D d, V a, V& sine, V& cosine) {
  const hn::RebindToSigned<D> di;
  const V magic = hn::Set(d, 12582912.0f), quarters = hn::Mul(hn::Set(d, 4.0f), a);
  const V shifted = hn::Add(quarters, magic);  // rounds to an integer, held in the low bits
  const V x = hn::Mul(hn::Sub(quarters, hn::Sub(shifted, magic)), hn::Set(d, kPi / 2)), q = hn::Mul(x, x);
  V s = hn::Set(d, 1.0f / 362880);
  s = hn::MulAdd(s, q, hn::Set(d, -1.0f / 5040));
  s = hn::MulAdd(s, q, hn::Set(d, 1.0f / 120));
  s = hn::MulAdd(s, q, hn::Set(d, -1.0f / 6));
  s = hn::MulAdd(hn::Mul(s, q), x, x);
  V c = hn::Set(d, 1.0f / 40320);
  c = hn::MulAdd(c, q, hn::Set(d, -1.0f / 720));
  c = hn::MulAdd(c, q, hn::Set(d, 1.0f / 24));
  c = hn::MulAdd(c, q, hn::Set(d, -0.5f));
  c = hn::MulAdd(c, q, hn::Set(d, 1.0f));
  const auto quarter = hn::BitCast(di, shifted), one = hn::Set(di, 1), two = hn::Set(di, 2);
  const auto odd = hn::MaskFromVec(hn::BitCast(d, hn::Neg(hn::And(quarter, one))));
  const auto sign = [&](auto k) { return hn::BitCast(d, hn::ShiftLeft<30>(hn::And(k, two))); };
  sine = hn::Xor(hn::IfThenElse(odd, c, s), sign(quarter));
  cosine = hn::Xor(hn::IfThenElse(odd, s, c), sign(hn::Add(quarter, one)));
}

/// Direction in Frame::about(axis) of a zenith, given by `sine` and cosine `z`, and an azimuth in turns.
template <class D, class V = hn::Vec<D>>
HWY_INLINE Vector<V> about_axis(D d, const Vector<V>& axis, V sine, V z, V azimuth) {
  V sin_phi, cos_phi;
  sin_cos_of_turns(d, azimuth, sin_phi, cos_phi);
  const V x = hn::Mul(sine, cos_phi), y = hn::Mul(sine, sin_phi), one = hn::Set(d, 1.0f);
  const V sign = hn::CopySign(one, axis.z);
  const V a = hn::Neg(hn::Div(one, hn::Add(sign, axis.z))), b = hn::Mul(hn::Mul(axis.x, axis.y), a);
  const V xx = hn::MulAdd(hn::Mul(hn::Mul(sign, axis.x), axis.x), a, one);
  const V yy = hn::MulAdd(hn::Mul(axis.y, axis.y), a, sign);
  const V signed_x = hn::Mul(x, sign), down = hn::MulAdd(signed_x, axis.x, hn::Mul(y, axis.y));
  return {hn::MulAdd(x, xx, hn::MulAdd(y, b, hn::Mul(z, axis.x))),
          hn::MulAdd(signed_x, b, hn::MulAdd(y, yy, hn::Mul(z, axis.y))), hn::MulSub(z, axis.z, down)};
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#endif

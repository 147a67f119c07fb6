// Elementary functions of the SIMD kernels. Included once per instruction set by sources that use foreach_target.h.
#if defined(VELOUR_SRBF_SIMD_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VELOUR_SRBF_SIMD_MATH_INL_H_
#undef VELOUR_SRBF_SIMD_MATH_INL_H_
#else
#define VELOUR_SRBF_SIMD_MATH_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// 2^y for -127 <= y <= 127, exactly 0 below 2^-126.5. Relative error 1.7e-7, of which 9.2e-8 is due to the polynomial:
/// the minimax of degree 5 on [-1/2, 1/2] with p(0) = 1 (coefficients by our own exchange iteration).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2_in_range(D d, V y) {
  const hn::RebindToSigned<D> di;
  // Adding 1.5 2^23 rounds to an integer, held in the low bits; the further 127 makes it the exponent field of 2^n.
  const V magic = hn::Set(d, 12582912.0f + 127.0f);
  const V shifted = hn::Add(y, magic);
  const V f = hn::Sub(y, hn::Sub(shifted, magic));
  const V power = hn::BitCast(d, hn::ShiftLeft<23>(hn::BitCast(di, shifted)));
  V p = hn::Set(d, 0x1.5bba14p-10f);
  p = hn::MulAdd(p, f, hn::Set(d, 0x1.3cea88p-7f));
  p = hn::MulAdd(p, f, hn::Set(d, 0x1.c6b752p-5f));
  p = hn::MulAdd(p, f, hn::Set(d, 0x1.ebf9bcp-3f));
  p = hn::MulAdd(p, f, hn::Set(d, 0x1.62e42ap-1f));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f));
  return hn::Mul(p, power);
}

/// 2^y for y <= 0; 0 below the range.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2_nonpositive(D d, V y) {
  return exp2_in_range(d, hn::Max(y, hn::Set(d, -127.0f)));  // exponent field 0 gives 0
}

/// 2^y for any y; 0 below the range, 2^127 above.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2_clamped(D d, V y) {
  return exp2_nonpositive(d, hn::Min(y, hn::Set(d, 127.0f)));
}

/// e^x for x <= 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp_nonpositive(D d, V x) {
  return exp2_nonpositive(d, hn::Mul(x, hn::Set(d, 1.44269504f)));
}

/// -log x of x in (0, 1], where `gap` is 1 - x at full precision; relative error below 3e-7, 0 at gap 0. Uses
/// x = 2^n m, m in [sqrt(1/2), sqrt 2), and the series of log m = 2 artanh s, s = (m - 1) / (m + 1), up to s^9.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V minus_log(D d, V x, V gap) {
  const hn::RebindToSigned<D> di;
  const auto bits = hn::BitCast(di, x);
  const auto n = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, 0x3f3504f3)));
  const V m = hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(n)));
  const V exponent = hn::ConvertTo(d, n), one = hn::Set(d, 1.0f);
  const V above_one = hn::IfThenElse(hn::Eq(exponent, hn::Zero(d)), hn::Neg(gap), hn::Sub(m, one));
  const V s = hn::Div(above_one, hn::Add(above_one, hn::Set(d, 2.0f)));
  const V q = hn::Mul(s, s), q2 = hn::Mul(q, q);
  const V low = hn::MulAdd(q, hn::Set(d, 2.0f / 3), hn::Set(d, 2.0f));
  const V high = hn::MulAdd(q, hn::Set(d, 2.0f / 7), hn::Set(d, 2.0f / 5));
  const V series = hn::MulAdd(q2, hn::MulAdd(q2, hn::Set(d, 2.0f / 9), high), low);
  return hn::NegMulSub(s, series, hn::Mul(exponent, hn::Set(d, 0.693147181f)));
}

/// Sine and cosine of x, |x| <= pi, absolute errors below 2e-7, the sine's relative to |x|. Uses the half angle,
/// sin x = 2 s c and cos x = 1 - 2 s^2, by Taylor series whose next terms are (pi/2)^13 / 13! and (pi/2)^14 / 14!.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void sin_cos_within_pi(D d, V x, V& sine, V& cosine) {
  const V half = hn::Mul(hn::Set(d, 0.5f), x), q = hn::Mul(half, half), one = hn::Set(d, 1.0f);
  V s = hn::Set(d, -1.0f / 39916800);
  s = hn::MulAdd(s, q, hn::Set(d, 1.0f / 362880));
  s = hn::MulAdd(s, q, hn::Set(d, -1.0f / 5040));
  s = hn::MulAdd(s, q, hn::Set(d, 1.0f / 120));
  s = hn::MulAdd(s, q, hn::Set(d, -1.0f / 6));
  s = hn::Mul(half, hn::MulAdd(s, q, one));
  V c = hn::Set(d, 1.0f / 479001600);
  c = hn::MulAdd(c, q, hn::Set(d, -1.0f / 3628800));
  c = hn::MulAdd(c, q, hn::Set(d, 1.0f / 40320));
  c = hn::MulAdd(c, q, hn::Set(d, -1.0f / 720));
  c = hn::MulAdd(c, q, hn::Set(d, 1.0f / 24));
  c = hn::MulAdd(c, q, hn::Set(d, -0.5f));
  c = hn::MulAdd(c, q, one);
  const V twice = hn::Add(s, s);
  sine = hn::Mul(twice, c);
  cosine = hn::NegMulAdd(twice, s, one);
}

/// 1 / sqrt(x) of a positive normal number, relative error below 4e-7: the processor's estimate plus Newton steps.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V reciprocal_sqrt(D d, V x) {
  const V half_x = hn::Mul(hn::Set(d, 0.5f), x), one_and_half = hn::Set(d, 1.5f);
  V y = hn::ApproximateReciprocalSqrt(x);
  constexpr int kSteps = HWY_ARCH_X86 ? 1 : 3;  // at least 11 bits on x86, as few as 5 elsewhere
  for (int i = 0; i < kSteps; ++i) y = hn::Mul(y, hn::NegMulAdd(hn::Mul(half_x, y), y, one_and_half));
  return y;
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#endif

// Elementary functions of the SIMD kernels. Included once for each instruction set, by sources that Highway compiles
// so.
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

/// 2^y for y <= 0, exactly 0 below 2^-126.5. Relative error 1.7e-7, of which 9.2e-8 is the polynomial: the minimax of
/// degree 5 on [-1/2, 1/2] with p(0) = 1 (coefficients by our own exchange iteration).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp2_nonpositive(D d, V y) {
  const hn::RebindToSigned<D> di;
  // Adding 1.5 2^23 rounds to an integer, held in the low bits; the further 127 makes it the exponent field of 2^n.
  const V magic = hn::Set(d, 12582912.0f + 127.0f);
  const V clamped = hn::Max(y, hn::Set(d, -127.0f));  // exponent field 0: the number 0
  const V shifted = hn::Add(clamped, magic);
  const V f = hn::Sub(clamped, hn::Sub(shifted, magic));
  const V power = hn::BitCast(d, hn::ShiftLeft<23>(hn::BitCast(di, shifted)));
  V p = hn::Set(d, 0x1.5bba14p-10f);
  p = hn::MulAdd(p, f, hn::Set(d, 0x1.3cea88p-7f));
  p = hn::MulAdd(p, f, hn::Set(d, 0x1.c6b752p-5f));
  p = hn::MulAdd(p, f, hn::Set(d, 0x1.ebf9bcp-3f));
  p = hn::MulAdd(p, f, hn::Set(d, 0x1.62e42ap-1f));
  p = hn::MulAdd(p, f, hn::Set(d, 1.0f));
  return hn::Mul(p, power);
}

/// e^x for x <= 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V exp_nonpositive(D d, V x) {
  return exp2_nonpositive(d, hn::Mul(x, hn::Set(d, 1.44269504f)));
}

/// 1 / sqrt(x) of a positive normal number, relative error below 4e-7: the processor's estimate and Newton's steps.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V reciprocal_sqrt(D d, V x) {
  const V half_x = hn::Mul(hn::Set(d, 0.5f), x), one_and_half = hn::Set(d, 1.5f);
  V y = hn::ApproximateReciprocalSqrt(x);
  constexpr int kSteps = HWY_ARCH_X86 ? 1 : 3;  // the estimate has 11 bits or more there, as few as 5 elsewhere
  for (int i = 0; i < kSteps; ++i) y = hn::Mul(y, hn::NegMulAdd(hn::Mul(half_x, y), y, one_and_half));
  return y;
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#endif

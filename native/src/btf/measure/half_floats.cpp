// Highway compiles this file once for each instruction set.
#include "btf/measure/half_floats.h"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "btf/measure/half_floats.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Full vectors first, then the remainder through padded copies, with the same arithmetic.
template <class From, class To, class Convert>
HWY_INLINE void convert_all(const From* from, To* to, size_t count, size_t lanes, const Convert& convert) {
  size_t i = 0;
  for (; i + lanes <= count; i += lanes) convert(from + i, to + i);
  if (i == count) return;
  HWY_ALIGN From padded[HWY_MAX_BYTES / 2] = {};
  HWY_ALIGN To converted[HWY_MAX_BYTES / 2];
  std::memcpy(padded, from + i, (count - i) * sizeof(From));
  convert(padded, converted);
  std::memcpy(to + i, converted, (count - i) * sizeof(To));
}

// Targets with conversion instructions. Highway's fallback for others lacks infinities and halves below 2^-14.
#define VELOUR_HAS_HALVES (HWY_TARGET <= HWY_AVX2)

template <class DF>
HWY_INLINE hn::Vec<DF> floats_of(DF df, hn::Vec<hn::Rebind<HalfBits, DF>> halves) {
#if VELOUR_HAS_HALVES
  return hn::PromoteTo(df, hn::BitCast(hn::Rebind<hwy::float16_t, DF>(), halves));
#else
  const hn::RebindToUnsigned<DF> du;
  const auto bits = hn::PromoteTo(du, halves);
  const auto magnitude = hn::And(bits, hn::Set(du, 0x7fffu));
  // Multiplication corrects the exponent bias and normalizes subnormal halves.
  const auto finite = hn::BitCast(du, hn::Mul(hn::BitCast(df, hn::ShiftLeft<13>(magnitude)), hn::Set(df, 0x1p112f)));
  const auto special = hn::Gt(magnitude, hn::Set(du, 0x7bffu));
  const auto value = hn::Or(finite, hn::IfThenElseZero(special, hn::Set(du, 0x7f800000u)));
  return hn::BitCast(df, hn::Or(value, hn::ShiftLeft<16>(hn::AndNot(hn::Set(du, 0x7fffu), bits))));
#endif
}

template <class DF>
HWY_INLINE hn::Vec<hn::Rebind<HalfBits, DF>> halves_of(DF df, hn::Vec<DF> floats) {
  const hn::Rebind<HalfBits, DF> dh;
#if VELOUR_HAS_HALVES
  return hn::BitCast(dh, hn::DemoteTo(hn::Rebind<hwy::float16_t, DF>(), floats));
#else
  const hn::RebindToUnsigned<DF> du;
  const auto magnitude = hn::BitCast(du, hn::Abs(floats));
  const auto sign = hn::ShiftRight<16>(hn::AndNot(hn::Set(du, 0x7fffffffu), hn::BitCast(du, floats)));
  const auto odd = hn::And(hn::ShiftRight<13>(magnitude), hn::Set(du, 1u));
  const auto rebias = hn::Set(du, 0xc8000fffu);  // (15 - 127) << 23, plus just below half a unit in the last place
  const auto normal = hn::ShiftRight<13>(hn::Add(hn::Add(magnitude, rebias), odd));
  // Adding 0.5 rounds a small number to the precision of halves below 2^-14.
  const auto half = hn::Set(df, 0.5f);
  const auto small = hn::Sub(hn::BitCast(du, hn::Add(hn::BitCast(df, magnitude), half)), hn::BitCast(du, half));
  auto value = hn::IfThenElse(hn::Lt(magnitude, hn::Set(du, 0x38800000u)), small, normal);           // 2^-14
  value = hn::IfThenElse(hn::Gt(magnitude, hn::Set(du, 0x477fefffu)), hn::Set(du, 0x7c00u), value);  // below 65520
  value = hn::IfThenElse(hn::Gt(magnitude, hn::Set(du, 0x7f800000u)), hn::Set(du, 0x7e00u), value);  // not a number
  return hn::DemoteTo(dh, hn::BitCast(hn::RebindToSigned<DF>(), hn::Or(value, sign)));
#endif
}

void to_floats(const HalfBits* halves, float* floats, size_t count) {
  const hn::ScalableTag<float> df;
  const hn::Rebind<HalfBits, decltype(df)> dh;
  convert_all(halves, floats, count, hn::Lanes(df),
              [&](const HalfBits* from, float* to) { hn::StoreU(floats_of(df, hn::LoadU(dh, from)), df, to); });
}

void to_halves(const float* floats, HalfBits* halves, size_t count) {
  const hn::ScalableTag<float> df;
  const hn::Rebind<HalfBits, decltype(df)> dh;
  convert_all(floats, halves, count, hn::Lanes(df),
              [&](const float* from, HalfBits* to) { hn::StoreU(halves_of(df, hn::LoadU(df, from)), dh, to); });
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(to_floats);
HWY_EXPORT(to_halves);

void halves_to_floats(std::span<const HalfBits> halves, std::span<float> floats) {
  VELOUR_SIMD_DISPATCH(to_floats)(halves.data(), floats.data(), floats.size());
}

void floats_to_halves(std::span<const float> floats, std::span<HalfBits> halves) {
  VELOUR_SIMD_DISPATCH(to_halves)(floats.data(), halves.data(), halves.size());
}

}  // namespace velour
#endif

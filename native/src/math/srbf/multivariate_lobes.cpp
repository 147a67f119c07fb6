// Highway compiles this file once for each instruction set.
#include "math/srbf/multivariate_lobes.h"

#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/srbf/multivariate_lobes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "math/sphere/simd_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, MultivariateLobes::kPadding>;

constexpr uint32_t kNumbers = MultivariateLobe::kNumbers;

/// The components of the arguments, to be broadcast to all lanes.
struct Broadcast {
  explicit Broadcast(const LobeArguments& at) {
    for (uint32_t i = 0; i < kNumbers; ++i) value[i] = at[static_cast<int>(i)];
  }
  float value[kNumbers];
};

constexpr uint32_t kBlock = MultivariateLobes::kPadding, kRows = kNumbers + 1;

/// Values of consecutive lobes of a block, one per lane.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V lobe_values(D d, const Broadcast& at, const float* exponent) {
  const auto row = [&](uint32_t i) { return hn::Load(d, exponent + i * kBlock); };
  // Two independent chains of sums hide latency.
  V even = row(kNumbers), odd = hn::Mul(hn::Set(d, at.value[1]), row(1));
  for (uint32_t i = 0; i < kNumbers; i += 2) even = hn::MulAdd(hn::Set(d, at.value[i]), row(i), even);
  for (uint32_t i = 3; i < kNumbers; i += 2) odd = hn::MulAdd(hn::Set(d, at.value[i]), row(i), odd);
  // Rounding may leave a peak slightly above 2^0, which exp2_nonpositive tolerates.
  return exp2_nonpositive(d, hn::Add(even, odd));
}

void write_values(const LobeArguments& at, const float* exponent, uint32_t padded, float* values) {
  const Lanes d;
  const Broadcast broadcast(at);
  for (uint32_t block = 0; block < padded; block += kBlock, exponent += kRows * kBlock) {
    for (uint32_t k = 0; k < kBlock; k += static_cast<uint32_t>(hn::Lanes(d))) {
      hn::Store(lobe_values(d, broadcast, exponent + k), d, values + block + k);
    }
  }
}

struct Sums {
  hn::Vec<Lanes> r, g, b;
};

/// Adds the values of `padded` lobes times coefficients and colors; advances `coefficient` and `color` past them.
HWY_INLINE void add_sums(const LobeArguments& at, const float* exponent, uint32_t padded, const float*& coefficient,
                         const float*& color, Sums& sums) {
  const Lanes d;
  const Broadcast broadcast(at);
  for (uint32_t block = 0; block < padded; block += kBlock, exponent += kRows * kBlock) {
    for (uint32_t k = 0; k < kBlock; k += static_cast<uint32_t>(hn::Lanes(d))) {
      const auto value = hn::Mul(lobe_values(d, broadcast, exponent + k), hn::Load(d, coefficient + k));
      sums.r = hn::MulAdd(value, hn::Load(d, color + k), sums.r);
      sums.g = hn::MulAdd(value, hn::Load(d, color + kBlock + k), sums.g);
      sums.b = hn::MulAdd(value, hn::Load(d, color + 2 * kBlock + k), sums.b);
    }
    coefficient += kBlock;
    color += 3 * kBlock;
  }
}

HWY_FLATTEN void write_sums(const ColoredLobes& lobes, const std::array<const float*, 2>& exponents,
                            const DirectionPair& pair, const Mat3& turn, const float* coefficient, float* to) {
  Sums sums{hn::Zero(Lanes()), hn::Zero(Lanes()), hn::Zero(Lanes())};
  const LobeArguments at(pair);
  const float* color = lobes.color;
  add_sums(at, exponents[0], lobes.lobes.padded(), coefficient, color, sums);
  add_sums(at.turned(turn), exponents[1], lobes.turned.padded(), coefficient, color, sums);
  to[0] = hn::GetLane(hn::SumOfLanes(Lanes(), sums.r));
  to[1] = hn::GetLane(hn::SumOfLanes(Lanes(), sums.g));
  to[2] = hn::GetLane(hn::SumOfLanes(Lanes(), sums.b));
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(write_values);
HWY_EXPORT(write_sums);

MultivariateLobes::MultivariateLobes(std::span<const MultivariateLobe> lobes)
    : size_(static_cast<uint32_t>(lobes.size())),
      padded_((size_ + kPadding - 1) / kPadding * kPadding),
      exponent_(size_t{MultivariateLobe::kNumbers + 1} * padded_) {
  constexpr float kPowersOf2 = 1.44269504f;
  constexpr float kNothing = -1000.0f;  // 2^-1000 is 0
  for (uint32_t k = 0; k < padded_; ++k) {
    constexpr int kNumbers = MultivariateLobe::kNumbers;
    float* const block = exponent_.data() + size_t{k / kPadding} * (kNumbers + 1) * kPadding;
    const auto at = [&](int i) -> float& { return block[static_cast<uint32_t>(i) * kPadding + k % kPadding]; };
    for (int i = 0; i < kNumbers; ++i) at(i) = k < size_ ? kPowersOf2 * lobes[k][i] : 0.0f;
    float peak = 0;
    for (int a = 0; k < size_ && a < MultivariateLobe::kArguments; ++a) peak += lobes[k].length(a);
    at(kNumbers) = k < size_ ? -kPowersOf2 * peak : kNothing;
  }
}

void MultivariateLobes::values(const LobeArguments& at, float* values) const {
  VELOUR_SIMD_DISPATCH(write_values)(at, exponent_.data(), padded_, values);
}

Vec3 lobe_sums(const ColoredLobes& lobes, const DirectionPair& pair, const Mat3& turn, const float* coefficient) {
  float sums[3];
  const auto write = VELOUR_SIMD_DISPATCH(write_sums);
  write(lobes, {lobes.lobes.exponent_.data(), lobes.turned.exponent_.data()}, pair, turn, coefficient, sums);
  return {sums[0], sums[1], sums[2]};
}

}  // namespace velour
#endif

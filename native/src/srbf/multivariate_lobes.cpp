// Highway compiles this file once for each instruction set.
#include "srbf/multivariate_lobes.h"

#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "srbf/multivariate_lobes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "srbf/simd_dispatch.h"
#include "srbf/simd_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, MultivariateLobes::kPadding>;

/// The nine components of the arguments, in all lanes.
struct Broadcast {
  explicit Broadcast(const LobeArguments& at) {
    const Vec3* const arguments[] = {&at.wl, &at.wv, &at.half};
    for (int i = 0; i < 9; ++i) value[i] = (*arguments[i / 3])[i % 3];
  }
  float value[9];
};

constexpr uint32_t kBlock = MultivariateLobes::kPadding, kRows = 10;

/// Of as many lobes of a block as there are lanes.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V lobe_values(D d, const Broadcast& at, const float* exponent) {
  const auto row = [&](uint32_t i) { return hn::Load(d, exponent + i * kBlock); };
  // Two chains of sums, so that one need not wait for the other.
  V even = row(9), odd = hn::Mul(hn::Set(d, at.value[1]), row(1));
  for (uint32_t i = 0; i < 9; i += 2) even = hn::MulAdd(hn::Set(d, at.value[i]), row(i), even);
  for (uint32_t i = 3; i < 9; i += 2) odd = hn::MulAdd(hn::Set(d, at.value[i]), row(i), odd);
  // Rounding may leave a peak a little above 2^0: exp2_nonpositive takes that.
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

/// `blocks`: of lobes, coefficients and colours that begin at these addresses; both of the latter are moved on.
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
      exponent_(size_t{10} * padded_) {
  constexpr float kPowersOf2 = 1.44269504f;
  constexpr float kNothing = -1000.0f;  // 2^-1000 is 0
  for (uint32_t k = 0; k < padded_; ++k) {
    float* const at = exponent_.data() + size_t{k / kPadding} * 10 * kPadding + k % kPadding;
    for (size_t i = 0; i < 9; ++i) at[i * kPadding] = 0;
    at[9 * kPadding] = kNothing;
    if (k >= size_) continue;
    const Vec3* const vectors[] = {&lobes[k].light, &lobes[k].view, &lobes[k].half};
    float peak = 0;
    for (size_t i = 0; i < 9; ++i) at[i * kPadding] = kPowersOf2 * (*vectors[i / 3])[static_cast<int>(i % 3)];
    for (const Vec3* v : vectors) peak += glm::length(*v);
    at[9 * kPadding] = -kPowersOf2 * peak;
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

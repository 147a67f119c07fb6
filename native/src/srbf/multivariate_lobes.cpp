// Highway compiles this file once for each instruction set.
#include "srbf/multivariate_lobes.h"

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

/// Of the lobes from `k` on.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V lobe_values(D d, const Broadcast& at, const float* exponent, uint32_t padded, uint32_t k) {
  // Two chains of sums, so that one need not wait for the other.
  V even = hn::LoadU(d, exponent + 9 * padded + k), odd = hn::Zero(d);
  for (uint32_t i = 0; i < 8; i += 2) {
    even = hn::MulAdd(hn::Set(d, at.value[i]), hn::LoadU(d, exponent + i * padded + k), even);
    odd = hn::MulAdd(hn::Set(d, at.value[i + 1]), hn::LoadU(d, exponent + (i + 1) * padded + k), odd);
  }
  even = hn::MulAdd(hn::Set(d, at.value[8]), hn::LoadU(d, exponent + 8 * padded + k), even);
  // Rounding may leave a peak a little above 2^0: exp2_nonpositive takes that.
  return exp2_nonpositive(d, hn::Add(even, odd));
}

void write_values(const LobeArguments& at, const float* exponent, uint32_t padded, float* values) {
  const Lanes d;
  const Broadcast broadcast(at);
  for (uint32_t k = 0; k < padded; k += static_cast<uint32_t>(hn::Lanes(d))) {
    hn::Store(lobe_values(d, broadcast, exponent, padded, k), d, values + k);
  }
}

void write_sums(const std::array<LobesAt, 2>& lobes, const std::array<const float*, 2>& exponent,
                std::array<const float*, 3> coefficient, float* sums) {
  const Lanes d;
  auto x = hn::Zero(d), y = hn::Zero(d), z = hn::Zero(d);
  for (size_t i = 0; i < 2; ++i) {
    const Broadcast broadcast(lobes[i].at);
    const uint32_t padded = lobes[i].lobes->padded();
    for (uint32_t k = 0; k < padded; k += static_cast<uint32_t>(hn::Lanes(d))) {
      const auto value = lobe_values(d, broadcast, exponent[i], padded, k);
      x = hn::MulAdd(value, hn::Load(d, coefficient[0] + k), x);
      y = hn::MulAdd(value, hn::Load(d, coefficient[1] + k), y);
      z = hn::MulAdd(value, hn::Load(d, coefficient[2] + k), z);
    }
    for (const float*& c : coefficient) c += padded;
  }
  sums[0] = hn::GetLane(hn::SumOfLanes(d, x));
  sums[1] = hn::GetLane(hn::SumOfLanes(d, y));
  sums[2] = hn::GetLane(hn::SumOfLanes(d, z));
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(write_values);
HWY_EXPORT(write_sums);

Vec3 half_vector(const DirectionPair& pair) {
  const Vec3 sum = pair.wl + pair.wv;
  const float length_sq = glm::dot(sum, sum);
  return length_sq > 1e-12f ? sum / std::sqrt(length_sq) : Vec3(0, 0, 1);
}

MultivariateLobes::MultivariateLobes(std::span<const MultivariateLobe> lobes)
    : size_(static_cast<uint32_t>(lobes.size())),
      padded_((size_ + kPadding - 1) / kPadding * kPadding),
      exponent_(size_t{10} * padded_) {
  constexpr float kPowersOf2 = 1.44269504f;
  constexpr float kNothing = -1000.0f;  // 2^-1000 is 0
  for (uint32_t k = 0; k < padded_; ++k) {
    float* const at = exponent_.data() + k;
    at[size_t{9} * padded_] = kNothing;
    if (k >= size_) continue;
    const Vec3* const vectors[] = {&lobes[k].light, &lobes[k].view, &lobes[k].half};
    float peak = 0;
    for (size_t i = 0; i < 9; ++i) at[i * padded_] = kPowersOf2 * (*vectors[i / 3])[static_cast<int>(i % 3)];
    for (const Vec3* v : vectors) peak += glm::length(*v);
    at[size_t{9} * padded_] = -kPowersOf2 * peak;
  }
}

void MultivariateLobes::values(const LobeArguments& at, float* values) const {
  VELOUR_SIMD_DISPATCH(write_values)(at, exponent_.data(), padded_, values);
}

Vec3 lobe_sums(const std::array<LobesAt, 2>& lobes, const std::array<const float*, 3>& coefficient) {
  float sums[3];
  const auto write = VELOUR_SIMD_DISPATCH(write_sums);
  write(lobes, {lobes[0].lobes->exponent_.data(), lobes[1].lobes->exponent_.data()}, coefficient, sums);
  return {sums[0], sums[1], sums[2]};
}

}  // namespace velour
#endif

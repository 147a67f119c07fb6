// Highway compiles this file once for each instruction set.
#include "math/srbf/lobe_products.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/srbf/lobe_products.cpp"
#include <hwy/foreach_target.h>

// These must follow foreach_target.h:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "math/sphere/simd_math-inl.h"
#include "math/srbf/front_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// 1 - exp(-2R): integral of a lobe of bandwidth R > 0, relative to that on a plane. Rounds to 1 in float for R > 9.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V share_of_ball(D d, V bandwidth) {
  if (hn::AllTrue(d, hn::Gt(bandwidth, hn::Set(d, 9.0f)))) return hn::Set(d, 1.0f);
  return hn::Neg(hn::Expm1(d, hn::Mul(hn::Set(d, -2.0f), bandwidth)));
}

/// Share of a lobe above a horizon whose normal is at cosine `c` to its center: the normal distribution function of
/// c sqrt(bandwidth), because a narrow lobe is a Gaussian of variance 1 / bandwidth, approximated by a logistic
/// function.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V share_above(D d, V c, V bandwidth) {
  const V x = hn::Mul(hn::Mul(hn::Set(d, 1.702f), c), hn::Sqrt(bandwidth));
  if (hn::AllTrue(d, hn::Gt(x, hn::Set(d, 17.0f)))) return hn::Set(d, 1.0f);
  const V e = exp_nonpositive(d, hn::Neg(hn::Abs(x)));
  const V top = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), e, hn::Set(d, 1.0f));
  return hn::Div(top, hn::Add(hn::Set(d, 1.0f), e));
}

void multiply_simd(const GaussianLobe& a, const LobeBlock& others, const Vec3* normal, LobeProducts& out) {
  const hn::CappedTag<float, LobeProducts::kLanes> d;
  using V = hn::Vec<decltype(d)>;
  const V ax = hn::Set(d, a.center.x), ay = hn::Set(d, a.center.y), az = hn::Set(d, a.center.z);
  const V la = hn::Set(d, a.bandwidth), flat = hn::Set(d, 1e-2f);
  for (size_t at = 0; at < LobeBlock::kSize; at += hn::Lanes(d)) {
    const auto load = [&](const float* values) HWY_ATTR { return hn::Load(d, values + at); };
    const V bx = load(others.x), by = load(others.y), bz = load(others.z), lb = load(others.bandwidth);
    const V dx = hn::Sub(ax, bx), dy = hn::Sub(ay, by), dz = hn::Sub(az, bz);
    const V distance_sq = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
    // R^2 = (la - lb)^2 + la lb |a + b|^2 and R - la - lb = -la lb |a - b|^2 / (R + la + lb): no cancellation.
    const V product = hn::Mul(la, lb), difference = hn::Sub(la, lb);
    const V sum_sq = hn::Max(hn::Sub(hn::Set(d, 4.0f), distance_sq), hn::Zero(d));
    const V exact = hn::Sqrt(hn::MulAdd(product, sum_sq, hn::Mul(difference, difference)));
    // For two broad opposite lobes, la a + lb b is only rounding error. The direction of a lobe this flat does not
    // matter, so it takes that of a.
    const auto no_axis = hn::Lt(exact, flat);
    const V r = hn::Max(exact, flat);
    const V exponent = hn::Div(hn::Mul(product, distance_sq), hn::Add(r, hn::Add(la, lb)));
    const size_t to = static_cast<size_t>(out.count) + at;
    // Most lobes of an environment are far from a highlight; exp(-88) is negligible.
    if (hn::AllTrue(d, hn::Gt(exponent, hn::Set(d, 88.0f)))) {
      hn::StoreU(hn::Zero(d), d, out.mass + to);
      continue;
    }
    const V inverse = hn::Div(hn::Set(d, 1.0f), r);
    const V cx = hn::IfThenElse(no_axis, ax, hn::Mul(inverse, hn::MulAdd(la, ax, hn::Mul(lb, bx))));
    const V cy = hn::IfThenElse(no_axis, ay, hn::Mul(inverse, hn::MulAdd(la, ay, hn::Mul(lb, by))));
    const V cz = hn::IfThenElse(no_axis, az, hn::Mul(inverse, hn::MulAdd(la, az, hn::Mul(lb, bz))));
    const V integral = hn::Mul(hn::Mul(hn::Set(d, 2 * kPi), inverse), share_of_ball(d, r));
    V mass = hn::Mul(hn::Mul(hn::Set(d, a.amplitude), load(others.amplitude)),
                     hn::Mul(integral, exp_nonpositive(d, hn::Neg(exponent))));
    if (normal != nullptr) {
      const V c = hn::MulAdd(hn::Set(d, normal->x), cx,
                             hn::MulAdd(hn::Set(d, normal->y), cy, hn::Mul(hn::Set(d, normal->z), cz)));
      mass = hn::Mul(mass, share_above(d, c, r));
    }
    hn::StoreU(mass, d, out.mass + to);
    hn::StoreU(cx, d, out.x + to);
    hn::StoreU(cy, d, out.y + to);
    hn::StoreU(cz, d, out.z + to);
    hn::StoreU(r, d, out.bandwidth + to);
  }
  out.count += LobeProducts::kLanes;
}

float total_simd(const LobeProducts& products) {
  const hn::CappedTag<float, LobeProducts::kLanes> d;
  auto sum = hn::Zero(d);
  for (int at = 0; at < products.count; at += static_cast<int>(hn::Lanes(d))) {
    sum = hn::Add(sum, hn::LoadU(d, products.mass + at));
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

/// Copies products with a mass of at least `least` to `mixture`, in order, and their masses to its densities; returns
/// their number.
int keep_simd(const LobeProducts& products, float least, LobeMixture& mixture) {
  // Whole vectors are written.
  static_assert(LobeProducts::kCapacity + LobeProducts::kLanes <= LobeMixture::kCapacity);
  const hn::CappedTag<float, LobeProducts::kLanes> d;
  const auto bound = hn::Set(d, least);
  size_t count = 0;
  for (int at = 0; at < products.count; at += static_cast<int>(hn::Lanes(d))) {
    const auto mass = hn::LoadU(d, products.mass + at);
    const auto kept = hn::Ge(mass, bound);
    if (hn::AllFalse(d, kept)) continue;
    const FrontLanes front(d, kept);
    const auto keep = [&](const float* from, float* to)
                          HWY_ATTR { hn::StoreU(front.of(d, hn::LoadU(d, from + at)), d, to + count); };
    keep(products.x, mixture.x), keep(products.y, mixture.y), keep(products.z, mixture.z);
    keep(products.bandwidth, mixture.bandwidth), keep(products.mass, mixture.density);
    count += front.count();
  }
  return static_cast<int>(count);
}

/// Converts masses in `density` and their running sums in `cdf` to densities and probabilities.
void normalize_simd(float sum, LobeMixture& mixture) {
  const hn::CappedTag<float, LobeProducts::kLanes> d;
  const auto total = hn::Set(d, sum);
  for (int at = 0; at < mixture.count; at += static_cast<int>(hn::Lanes(d))) {
    const auto r = hn::Max(hn::LoadU(d, mixture.bandwidth + at), hn::Set(d, 1e-12f));
    // The integral of the kernel is 2 pi (1 - e^-2R) / R.
    const auto whole = hn::Mul(hn::Set(d, 2 * kPi), share_of_ball(d, r));
    const auto mass = hn::LoadU(d, mixture.density + at);
    hn::StoreU(hn::Div(hn::Mul(mass, r), hn::Mul(total, whole)), d, mixture.density + at);
    // Dividing makes the last one exactly 1.
    hn::StoreU(hn::Div(hn::LoadU(d, mixture.cdf + at), total), d, mixture.cdf + at);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(multiply_simd);
HWY_EXPORT(total_simd);
HWY_EXPORT(keep_simd);
HWY_EXPORT(normalize_simd);

void GaussianLobes::add(const GaussianLobe& lobe) {
  x.push_back(lobe.center.x);
  y.push_back(lobe.center.y);
  z.push_back(lobe.center.z);
  bandwidth.push_back(lobe.bandwidth);
  amplitude.push_back(lobe.amplitude);
}

LobeBlock::LobeBlock() {
  for (size_t i = 0; i < kSize; ++i) set(i, {{0, 0, 1}, 1, 0});
}

void LobeBlock::set(size_t place, const GaussianLobe& lobe) {
  x[place] = lobe.center.x;
  y[place] = lobe.center.y;
  z[place] = lobe.center.z;
  bandwidth[place] = lobe.bandwidth;
  amplitude[place] = lobe.amplitude;
}

std::vector<LobeBlock> in_blocks(const GaussianLobes& lobes) {
  std::vector<LobeBlock> blocks((lobes.size() + LobeBlock::kSize - 1) / LobeBlock::kSize);
  for (size_t k = 0; k < lobes.size(); ++k) {
    blocks[k / LobeBlock::kSize].set(k % LobeBlock::kSize,
                                     {{lobes.x[k], lobes.y[k], lobes.z[k]}, lobes.bandwidth[k], lobes.amplitude[k]});
  }
  return blocks;
}

void multiply_lobes(const GaussianLobe& lobe, std::span<const LobeBlock> others, const Vec3* normal,
                    LobeProducts& products) {
  assert(products.count + static_cast<int>(others.size() * LobeBlock::kSize) <= LobeProducts::kCapacity);
  const auto multiply = VELOUR_SIMD_DISPATCH(multiply_simd);
  for (const LobeBlock& block : others) multiply(lobe, block, normal, products);
}

constexpr float kSmallest = std::numeric_limits<float>::min();  // excludes padding lanes, which have no mass

bool keep_products(const LobeProducts& products, float least, LobeMixture& mixture) {
  const float total = VELOUR_SIMD_DISPATCH(total_simd)(products);
  if (!(total >= LobeMixture::kMinMass) || !std::isfinite(total)) return false;
  mixture.clear(Kernel::gaussian);
  mixture.cosine_share = 0;
  mixture.count = VELOUR_SIMD_DISPATCH(keep_simd)(products, std::max(least * total, kSmallest), mixture);
  if (mixture.count == 0) {  // evenly spread: the best one represents all
    const float best = *std::max_element(products.mass, products.mass + products.count);
    mixture.count = VELOUR_SIMD_DISPATCH(keep_simd)(products, best, mixture);
  }
  float sum = 0;
  for (int k = 0; k < mixture.count; ++k) mixture.cdf[k] = sum += mixture.density[k];
  VELOUR_SIMD_DISPATCH(normalize_simd)(sum, mixture);
  return true;
}

}  // namespace velour
#endif

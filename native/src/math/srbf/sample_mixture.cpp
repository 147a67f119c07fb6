// Highway compiles this file once for each instruction set.
#include <algorithm>
#include <cassert>

#include "math/sphere/random.h"
#include "math/srbf/lobe_mixture.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/srbf/sample_mixture.cpp"
#include <hwy/foreach_target.h>

// These must follow foreach_target.h:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "math/srbf/draw_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// 1 - cos of the zenith about the axis: kernel_sample in float.
struct GaussianZenith {
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE V operator()(D d, V bandwidth, V u, V rest) const {
    const V l = hn::Max(bandwidth, hn::Set(d, 1e-12f)), exponent = hn::Mul(hn::Set(d, -2.0f), l);
    return gaussian_zenith(d, l, exp_nonpositive(d, exponent), hn::Neg(hn::Expm1(d, exponent)), u, rest);
  }
};

struct AbelPoissonZenith {
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE V operator()(D d, V b, V u, V rest) const {
    const V one = hn::Set(d, 1.0f);
    const V gap = hn::Sub(one, b);
    const V split = hn::MulAdd(hn::Add(b, b), u, gap);
    const V s = hn::Div(hn::Mul(gap, hn::Add(one, b)), split);
    return hn::Mul(hn::Div(hn::Mul(gap, rest), split), hn::Add(s, gap));
  }
};

template <class Zenith, class D>
HWY_INLINE void directions_of(D tag, const LobeDraws& draws, DirectionBatch& w) {
  using V = hn::Vec<D>;
  const V zero = hn::Zero(tag), one = hn::Set(tag, 1.0f), two = hn::Set(tag, 2.0f);
  for (int at = 0; at < draws.count; at += static_cast<int>(hn::Lanes(tag))) {
    const V bandwidth = hn::Load(tag, draws.bandwidth + at);
    const V u = hn::Load(tag, draws.u + at), rest = hn::Load(tag, draws.rest + at);
    const auto cosine = hn::Lt(bandwidth, zero);
    const V d = hn::Min(hn::Max(Zenith()(tag, hn::Abs(bandwidth), u, rest), zero), two);
    const V sine = hn::Sqrt(hn::IfThenElse(cosine, u, hn::Mul(d, hn::Sub(two, d))));
    const V z = hn::IfThenElse(cosine, hn::Sqrt(rest), hn::Sub(one, d));
    const Vector<V> axis{hn::Load(tag, draws.x + at), hn::Load(tag, draws.y + at), hn::Load(tag, draws.z + at)};
    const Vector<V> drawn = about_axis(tag, axis, sine, z, hn::Load(tag, draws.azimuth + at));
    hn::Store(drawn.x, tag, w.x + at);
    hn::Store(drawn.y, tag, w.y + at);
    hn::Store(drawn.z, tag, w.z + at);
  }
}

/// A single sample uses scalars, which have lower latency.
template <class Zenith>
HWY_INLINE void directions_of(const LobeDraws& draws, DirectionBatch& w) {
  if (draws.count == 1) return directions_of<Zenith>(hn::CappedTag<float, 1>(), draws, w);
  return directions_of<Zenith>(hn::CappedTag<float, 8>(), draws, w);
}

void directions_simd(Kernel kernel, const LobeDraws& draws, DirectionBatch& w) {
  if (kernel == Kernel::gaussian) return directions_of<GaussianZenith>(draws, w);
  return directions_of<AbelPoissonZenith>(draws, w);
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(directions_simd);

void LobeDraws::push(const Vec3& axis, float lobe_bandwidth, double u_zenith, float u_azimuth) {
  x[count] = axis.x;
  y[count] = axis.y;
  z[count] = axis.z;
  bandwidth[count] = lobe_bandwidth;
  u[count] = static_cast<float>(u_zenith);
  rest[count] = static_cast<float>(1 - u_zenith);
  azimuth[count++] = u_azimuth;
}

void LobeDraws::choose(const LobeMixture& mixture, std::span<const Vec2> numbers) {
  assert(static_cast<size_t>(count) + numbers.size() <= kCapacity);
  const double share = mixture.cosine_share;
  for (const Vec2& number : numbers) {
    double left = middle_of_step(number.x);
    if (left < share) {
      push({0, 0, 1}, kCosine, std::min(left / share, 1 - 0x1p-24), number.y);
      continue;
    }
    left = (left - share) / (1 - share);
    const int j = choose_index(mixture.cdf, mixture.count, left);
    const double zenith = j % 2 == 0 ? left : std::min(1 - left, 1 - 0x1p-53);
    push({mixture.x[j], mixture.y[j], mixture.z[j]}, mixture.bandwidth[j], zenith, number.y);
  }
}

void LobeDraws::directions(Kernel kernel, DirectionBatch& w) {
  w.count = count;
  while (count != 1 && count % 8 != 0) push({0, 0, 1}, kCosine, 0.5, 0.0f);
  VELOUR_SIMD_DISPATCH(directions_simd)(kernel, *this, w);
  count = w.count;
}

void sample_mixture(const LobeMixture& mixture, std::span<const Vec2> u, DirectionBatch& w) {
  LobeDraws draws;
  draws.choose(mixture, u);
  draws.directions(mixture.kernel, w);
}

Vec3 sample_mixture(const LobeMixture& mixture, const Vec2& u) {
  DirectionBatch w;
  sample_mixture(mixture, {&u, 1}, w);
  return w.get(0);
}

}  // namespace velour
#endif

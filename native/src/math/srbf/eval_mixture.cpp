// Highway compiles this file once for each instruction set.
#include <cstring>

#include "math/srbf/lobe_mixture.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/srbf/eval_mixture.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "math/sphere/simd_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A lobe's kernel as a function of its bandwidth and |w - xi|^2 = 2 d.

struct GaussianLobe {
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE V operator()(D d, V bandwidth, V distance_sq) const {
    const V slope = hn::Mul(bandwidth, hn::Set(d, -0.72134752f));  // -log2(e) / 2
    return exp2_nonpositive(d, hn::Mul(slope, distance_sq));
  }
};

struct AbelPoissonLobe {
  template <class D, class V = hn::Vec<D>>
  HWY_INLINE V operator()(D d, V b, V distance_sq) const {
    const V one = hn::Set(d, 1.0f), gap = hn::Sub(one, b);
    const V bottom = hn::MulAdd(b, distance_sq, hn::Mul(gap, gap));
    return hn::Div(hn::Mul(gap, hn::Add(one, b)), hn::Mul(bottom, hn::Sqrt(bottom)));
  }
};

/// Sums over the lobes, one direction per lane.
template <class V>
struct Sums {
  V r, g, b, density;
};

template <class D>
HWY_INLINE Sums<hn::Vec<D>> no_sums(D d) {
  return {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
}

/// Loads one lobe into every lane.
struct OneLobe {
  template <class D>
  HWY_INLINE hn::Vec<D> operator()(D d, const float* value) const {
    return hn::Set(d, *value);
  }
};

/// Loads two lobes into alternating lanes; each direction has two lanes. An odd last lobe is paired with zeros, a lobe
/// of coefficient 0.
template <size_t kLobes>
struct TwoLobes {
  template <class D>
  HWY_INLINE hn::Vec<D> operator()(D d, const float* values) const {
    const hn::Repartition<double, D> both;
    double bits = 0;
    std::memcpy(&bits, values, kLobes * sizeof(float));
    return hn::BitCast(d, hn::Set(both, bits));
  }
};

template <class Lobe, bool kColors, class Load, class D, class V = hn::Vec<D>>
HWY_INLINE void add_lobe(D d, const Load& load, const LobeMixture& m, int j, V wx, V wy, V wz, Sums<V>& sum) {
  const V dx = hn::Sub(wx, load(d, m.x + j)), dy = hn::Sub(wy, load(d, m.y + j)), dz = hn::Sub(wz, load(d, m.z + j));
  const V distance_sq = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
  const V kernel = Lobe()(d, load(d, m.bandwidth + j), distance_sq);
  if constexpr (kColors) {
    sum.r = hn::MulAdd(load(d, m.r + j), kernel, sum.r);
    sum.g = hn::MulAdd(load(d, m.g + j), kernel, sum.g);
    sum.b = hn::MulAdd(load(d, m.b + j), kernel, sum.b);
  }
  sum.density = hn::MulAdd(load(d, m.density + j), kernel, sum.density);
}

/// Adds the cosine term and stores.
template <bool kColors, class D, class V = hn::Vec<D>>
HWY_INLINE void store(D d, const LobeMixture& m, V wz, const Sums<V>& sum, int at, RgbBatch* value, ScalarBatch& pdf) {
  const V cosine = hn::Max(wz, hn::Zero(d));
  if constexpr (kColors) {
    hn::Store(hn::MulAdd(hn::Set(d, m.diffuse_r), cosine, sum.r), d, value->r + at);
    hn::Store(hn::MulAdd(hn::Set(d, m.diffuse_g), cosine, sum.g), d, value->g + at);
    hn::Store(hn::MulAdd(hn::Set(d, m.diffuse_b), cosine, sum.b), d, value->b + at);
  }
  hn::Store(hn::MulAdd(hn::Set(d, m.cosine_share / kPi), cosine, sum.density), d, pdf.v + at);
}

template <class Lobe, bool kColors, class D>
HWY_INLINE void eval_vector(D d, const LobeMixture& m, const DirectionBatch& w, int at, RgbBatch* value,
                            ScalarBatch& pdf) {
  const auto wx = hn::Load(d, w.x + at), wy = hn::Load(d, w.y + at), wz = hn::Load(d, w.z + at);
  auto sum = no_sums(d);
  for (int j = 0; j < m.count; ++j) add_lobe<Lobe, kColors>(d, OneLobe(), m, j, wx, wy, wz, sum);
  store<kColors>(d, m, wz, sum, at, value, pdf);
}

/// Evaluates up to eight directions, two lobes at a time in sixteen lanes.
template <class Lobe, bool kColors, class D>
HWY_INLINE void eval_pairs(D d, const LobeMixture& m, const DirectionBatch& w, int at, RgbBatch* value,
                           ScalarBatch& pdf) {
  const hn::Half<D> half;
  const hn::RebindToSigned<D> di;
  const auto twice = hn::IndicesFromVec(d, hn::ShiftRight<1>(hn::Iota(di, 0)));
  const auto doubled = [&](const float* values) { return hn::TableLookupLanes(hn::LoadU(d, values + at), twice); };
  const auto wx = doubled(w.x), wy = doubled(w.y), wz = doubled(w.z);
  auto sum = no_sums(d);
  int j = 0;
  for (; j + 1 < m.count; j += 2) add_lobe<Lobe, kColors>(d, TwoLobes<2>(), m, j, wx, wy, wz, sum);
  if (j < m.count) add_lobe<Lobe, kColors>(d, TwoLobes<1>(), m, j, wx, wy, wz, sum);
  const auto first = hn::And(hn::ShiftLeft<1>(hn::Iota(di, 0)), hn::Set(di, 15));
  const auto even = hn::IndicesFromVec(d, first), odd = hn::IndicesFromVec(d, hn::Or(first, hn::Set(di, 1)));
  const auto joined = [&](hn::Vec<D> v) {
    return hn::LowerHalf(half, hn::Add(hn::TableLookupLanes(v, even), hn::TableLookupLanes(v, odd)));
  };
  const Sums<hn::Vec<decltype(half)>> joint{joined(sum.r), joined(sum.g), joined(sum.b), joined(sum.density)};
  store<kColors>(half, m, hn::Load(half, w.z + at), joint, at, value, pdf);
}

template <class Lobe, bool kColors>
HWY_INLINE void eval_lobes(const LobeMixture& m, const DirectionBatch& w, RgbBatch* value, ScalarBatch& pdf) {
  const hn::CappedTag<float, 16> wide;
  const hn::CappedTag<float, 8> narrow;
  const int lanes = static_cast<int>(hn::Lanes(wide));
  int at = 0;
  for (; w.count - at > 8; at += lanes) eval_vector<Lobe, kColors>(wide, m, w, at, value, pdf);
  // The last eight or fewer directions would leave half of sixteen lanes empty.
  for (; at < w.count; at += 8) {
    if constexpr (hn::MaxLanes(wide) == 16) {
      eval_pairs<Lobe, kColors>(wide, m, w, at, value, pdf);
    } else {
      for (int k = at; k < at + 8; k += static_cast<int>(hn::Lanes(narrow))) {
        eval_vector<Lobe, kColors>(narrow, m, w, k, value, pdf);
      }
    }
  }
}

template <bool kColors>
HWY_INLINE void eval_kernel(const LobeMixture& m, const DirectionBatch& w, RgbBatch* value, ScalarBatch& pdf) {
  if (m.kernel == Kernel::gaussian) return eval_lobes<GaussianLobe, kColors>(m, w, value, pdf);
  return eval_lobes<AbelPoissonLobe, kColors>(m, w, value, pdf);
}

void eval_density_simd(const LobeMixture& m, const DirectionBatch& w, ScalarBatch& pdf) {
  eval_kernel<false>(m, w, nullptr, pdf);
}

void eval_mixture_simd(const LobeMixture& m, const DirectionBatch& w, RgbBatch& value, ScalarBatch& pdf) {
  eval_kernel<true>(m, w, &value, pdf);
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(eval_mixture_simd);
HWY_EXPORT(eval_density_simd);

void eval_mixture(const LobeMixture& mixture, const DirectionBatch& w, RgbBatch& value, ScalarBatch& pdf) {
  VELOUR_SIMD_DISPATCH(eval_mixture_simd)(mixture, w, value, pdf);
}

void eval_density(const LobeMixture& mixture, const DirectionBatch& w, ScalarBatch& pdf) {
  VELOUR_SIMD_DISPATCH(eval_density_simd)(mixture, w, pdf);
}

}  // namespace velour
#endif

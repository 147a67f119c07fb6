// Highway compiles this file once for each instruction set.
#include "math/srbf/warped_mixture.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/srbf/eval_warped.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "math/srbf/draw_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Loads the same lobe into every lane, or one lobe per lane.
struct SameLobe {
  template <class D>
  HWY_INLINE hn::Vec<D> operator()(D d, const float* value) const {
    return hn::Set(d, *value);
  }
};
struct LobeALane {
  template <class D>
  HWY_INLINE hn::Vec<D> operator()(D d, const float* values) const {
    return hn::Load(d, values);
  }
};

/// The data of a light direction that lobes need, in their frame.
template <class V>
struct Light {
  Vector<V> wl, wv;
  V half_gain;  // |wl + wv|^2 / 2 - 1: factor of the Jacobian of half lobes, minus the 1 of light lobes
};

template <class V>
struct Sums {
  V r, g, b, density;
};

template <class D>
HWY_INLINE Sums<hn::Vec<D>> no_sums(D d) {
  return {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
}

/// Sums the lanes of all four members.
template <class D>
HWY_INLINE void sum_lanes(D d, const Sums<hn::Vec<D>>& sum, float* total) {
#if HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE
  // Reduces all four at once: halves the vectors down to four lanes, then interleaves them.
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> h;
    const auto fold = [&](auto v) { return hn::Add(hn::LowerHalf(h, v), hn::UpperHalf(h, v)); };
    sum_lanes(h, {fold(sum.r), fold(sum.g), fold(sum.b), fold(sum.density)}, total);
  } else {
    const auto rb = hn::Add(hn::InterleaveLower(d, sum.r, sum.b), hn::InterleaveUpper(d, sum.r, sum.b));
    const auto gd = hn::Add(hn::InterleaveLower(d, sum.g, sum.density), hn::InterleaveUpper(d, sum.g, sum.density));
    hn::StoreU(hn::Add(hn::InterleaveLower(d, rb, gd), hn::InterleaveUpper(d, rb, gd)), d, total);
  }
#else
  const hn::Vec<D> sums[] = {sum.r, sum.g, sum.b, sum.density};
  for (int i = 0; i < 4; ++i) total[i] = hn::GetLane(hn::SumOfLanes(d, sums[i]));
#endif
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE Light<V> light_of(D d, const WarpedMixture& m, V x, V y, V z) {
  const V c = hn::Set(d, m.turn_cos), s = hn::Set(d, m.turn_sin);
  const Vector<V> wl{hn::MulAdd(c, x, hn::Mul(s, y)), hn::NegMulAdd(s, x, hn::Mul(c, y)), z};
  const Vector<V> wv{hn::Set(d, m.wv.x), hn::Set(d, m.wv.y), hn::Set(d, m.wv.z)};
  const V sx = hn::Add(wl.x, wv.x), sy = hn::Add(wl.y, wv.y), sz = hn::Add(wl.z, wv.z);
  const V length_sq = hn::MulAdd(sx, sx, hn::MulAdd(sy, sy, hn::Mul(sz, sz)));
  return {wl, wv, hn::MulSub(hn::Set(d, 0.5f), length_sq, hn::Set(d, 1.0f))};
}

/// exp(-bandwidth |psi - center|^2 / 2).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V gaussian(D d, const Vector<V>& psi, V x, V y, V z, V bandwidth) {
  const V dx = hn::Sub(psi.x, x), dy = hn::Sub(psi.y, y), dz = hn::Sub(psi.z, z);
  const V distance_sq = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
  return exp2_nonpositive(d, hn::Mul(hn::Mul(bandwidth, hn::Set(d, -0.72134752f)), distance_sq));  // -log2(e) / 2
}

template <bool kDensity, class Load, class D, class V = hn::Vec<D>>
HWY_INLINE void add_lobe(D d, const Load& load, const WarpedMixture& m, int j, const Light<V>& light, Sums<V>& sum) {
  const V half = load(d, m.half + j);
  // Add before stretching: nearly opposite wl and wv then cancel exactly.
  const V yx = hn::MulAdd(half, light.wv.x, light.wl.x), yy = hn::MulAdd(half, light.wv.y, light.wl.y);
  const V qz = hn::MulAdd(half, light.wv.z, light.wl.z);
  const V s_xy = load(d, m.s_xy + j);
  const V qx = hn::MulAdd(load(d, m.s_xx + j), yx, hn::Mul(s_xy, yy));
  const V qy = hn::MulAdd(s_xy, yx, hn::Mul(load(d, m.s_yy + j), yy));
  const V length_sq = hn::MulAdd(qx, qx, hn::MulAdd(qy, qy, hn::Mul(qz, qz)));
  const V inverse = reciprocal_sqrt(d, hn::Max(length_sq, hn::Set(d, 1e-20f)));  // wl = -wv has no half vector
  const Vector<V> psi{hn::Mul(qx, inverse), hn::Mul(qy, inverse), hn::Mul(qz, inverse)};

  const V value = gaussian(d, psi, load(d, m.x + j), load(d, m.y + j), load(d, m.z + j), load(d, m.bandwidth + j));
  sum.r = hn::MulAdd(load(d, m.r + j), value, sum.r);
  sum.g = hn::MulAdd(load(d, m.g + j), value, sum.g);
  sum.b = hn::MulAdd(load(d, m.b + j), value, sum.b);
  if constexpr (!kDensity) return;

  const V drawn = gaussian(d, psi, load(d, m.draw_x + j), load(d, m.draw_y + j), load(d, m.draw_z + j),
                           load(d, m.draw_bandwidth + j));
  const V gain = hn::MulAdd(half, light.half_gain, hn::Set(d, 1.0f));
  const V jacobian = hn::Mul(gain, hn::Mul(inverse, hn::Mul(inverse, inverse)));
  sum.density = hn::MulAdd(hn::Mul(load(d, m.density + j), drawn), jacobian, sum.density);
}

/// Without kDensity, evaluates only the value and ignores `pdf`.
template <bool kDensity, class D, class V = hn::Vec<D>>
HWY_INLINE void eval_directions(D d, const WarpedMixture& m, const DirectionBatch& w, int at, RgbBatch& f,
                                ScalarBatch* pdf) {
  const V z = hn::Load(d, w.z + at), zero = hn::Zero(d);
  const Light<V> light = light_of(d, m, hn::Load(d, w.x + at), hn::Load(d, w.y + at), z);
  Sums<V> sum = no_sums(d);
  for (int k = 0; k < m.listed_count; ++k) add_lobe<kDensity>(d, SameLobe(), m, m.listed[k], light, sum);
  const auto above = hn::Gt(z, zero);
  hn::Store(hn::IfThenElseZero(above, sum.r), d, f.r + at);
  hn::Store(hn::IfThenElseZero(above, sum.g), d, f.g + at);
  hn::Store(hn::IfThenElseZero(above, sum.b), d, f.b + at);
  if constexpr (kDensity) {
    hn::Store(hn::MulAdd(hn::Set(d, m.cosine() / kPi), hn::Max(z, zero), sum.density), d, pdf->v + at);
  }
}

template <bool kDensity, class D>
HWY_INLINE void eval_lobes(D d, const WarpedMixture& m, const Vec3& wl, Rgb& f, float* pdf) {
  using V = hn::Vec<D>;
  const Light<V> light = light_of(d, m, hn::Set(d, wl.x), hn::Set(d, wl.y), hn::Set(d, wl.z));
  Sums<V> sum = no_sums(d);
  for (int j = 0; j < m.padded; j += static_cast<int>(hn::Lanes(d))) {
    add_lobe<kDensity>(d, LobeALane(), m, j, light, sum);
  }
  float total[4];
  sum_lanes(d, sum, total);
  f = wl.z > 0 ? Rgb(total[0], total[1], total[2]) : Rgb(0);
  if constexpr (kDensity) *pdf = m.cosine() / kPi * std::max(wl.z, 0.0f) + total[3];
}

template <bool kDensity>
HWY_INLINE void eval_one(const WarpedMixture& m, const Vec3& wl, Rgb& f, float* pdf) {
  if (m.padded % 16 == 0) return eval_lobes<kDensity>(hn::CappedTag<float, 16>(), m, wl, f, pdf);
  return eval_lobes<kDensity>(hn::CappedTag<float, 8>(), m, wl, f, pdf);
}

template <bool kDensity>
HWY_INLINE void eval_batch(const WarpedMixture& m, const DirectionBatch& w, RgbBatch& f, ScalarBatch* pdf) {
  if (w.count <= 2) {
    for (int i = 0; i < w.count; ++i) {
      Rgb value;
      eval_one<kDensity>(m, w.get(i), value, kDensity ? pdf->v + i : nullptr);
      f.set(i, value);
    }
    return;
  }
  const hn::CappedTag<float, 16> d;
  for (int at = 0; at < w.count; at += static_cast<int>(hn::Lanes(d))) eval_directions<kDensity>(d, m, w, at, f, pdf);
}

void eval_one_simd(const WarpedMixture& m, const Vec3& wl, Rgb& f, float* pdf) {
  return pdf != nullptr ? eval_one<true>(m, wl, f, pdf) : eval_one<false>(m, wl, f, pdf);
}

void eval_batch_simd(const WarpedMixture& m, const DirectionBatch& w, RgbBatch& f, ScalarBatch* pdf) {
  return pdf != nullptr ? eval_batch<true>(m, w, f, pdf) : eval_batch<false>(m, w, f, pdf);
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <array>

namespace velour {

HWY_EXPORT(eval_batch_simd);
HWY_EXPORT(eval_one_simd);

namespace {

constexpr auto kAll = [] {
  std::array<uint8_t, WarpedMixture::kCapacity> all{};
  for (size_t j = 0; j < all.size(); ++j) all[j] = static_cast<uint8_t>(j);
  return all;
}();

}  // namespace

void WarpedMixture::list_all() {
  listed = kAll.data();
  listed_count = count;
}

void eval_warped(const WarpedMixture& mixture, const DirectionBatch& wl, RgbBatch& f, ScalarBatch& pdf) {
  VELOUR_SIMD_DISPATCH(eval_batch_simd)(mixture, wl, f, &pdf);
}

void eval_warped(const WarpedMixture& mixture, const Vec3& wl, Rgb& f, float& pdf) {
  VELOUR_SIMD_DISPATCH(eval_one_simd)(mixture, wl, f, &pdf);
}

void eval_warped(const WarpedMixture& mixture, const DirectionBatch& wl, RgbBatch& f) {
  VELOUR_SIMD_DISPATCH(eval_batch_simd)(mixture, wl, f, nullptr);
}

Rgb eval_warped(const WarpedMixture& mixture, const Vec3& wl) {
  Rgb f;
  VELOUR_SIMD_DISPATCH(eval_one_simd)(mixture, wl, f, nullptr);
  return f;
}

}  // namespace velour
#endif

// Highway compiles this file once for each instruction set.
#include "srbf/lobe_mixture.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "srbf/eval_mixture.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "srbf/simd_dispatch.h"
#include "srbf/simd_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One lobe's kernel as a function of |w - xi|^2 = 2 d; what depends on the bandwidth alone is computed once a batch.
struct GaussianLobe {
  explicit GaussianLobe(float bandwidth) : slope(bandwidth * -0.72134752f) {}  // -log2(e) / 2

  template <class D, class V = hn::Vec<D>>
  HWY_INLINE V operator()(D d, V distance_sq) const {
    return exp2_nonpositive(d, hn::Mul(hn::Set(d, slope), distance_sq));
  }

  float slope;
};

struct AbelPoissonLobe {
  explicit AbelPoissonLobe(float b) : b_(b), gap_sq((1 - b) * (1 - b)), top((1 - b) * (1 + b)) {}

  template <class D, class V = hn::Vec<D>>
  HWY_INLINE V operator()(D d, V distance_sq) const {
    const V bottom = hn::MulAdd(hn::Set(d, b_), distance_sq, hn::Set(d, gap_sq));
    return hn::Div(hn::Set(d, top), hn::Mul(bottom, hn::Sqrt(bottom)));
  }

  float b_, gap_sq, top;
};

template <class Lobe, class D>
HWY_INLINE void eval_vector(D d, const LobeMixture& m, const DirectionBatch& w, int at, RgbBatch& value,
                            ScalarBatch& pdf) {
  using V = hn::Vec<D>;
  const V wx = hn::Load(d, w.x + at), wy = hn::Load(d, w.y + at), wz = hn::Load(d, w.z + at);
  const V cosine = hn::Max(wz, hn::Zero(d));
  V r = hn::Mul(hn::Set(d, m.diffuse_r), cosine);
  V g = hn::Mul(hn::Set(d, m.diffuse_g), cosine);
  V b = hn::Mul(hn::Set(d, m.diffuse_b), cosine);
  V density = hn::Mul(hn::Set(d, m.cosine_share / kPi), cosine);
  for (int j = 0; j < m.count; ++j) {
    const V dx = hn::Sub(wx, hn::Set(d, m.x[j]));
    const V dy = hn::Sub(wy, hn::Set(d, m.y[j]));
    const V dz = hn::Sub(wz, hn::Set(d, m.z[j]));
    const V kernel = Lobe(m.bandwidth[j])(d, hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz))));
    r = hn::MulAdd(hn::Set(d, m.r[j]), kernel, r);
    g = hn::MulAdd(hn::Set(d, m.g[j]), kernel, g);
    b = hn::MulAdd(hn::Set(d, m.b[j]), kernel, b);
    density = hn::MulAdd(hn::Set(d, m.density[j]), kernel, density);
  }
  hn::Store(r, d, value.r + at);
  hn::Store(g, d, value.g + at);
  hn::Store(b, d, value.b + at);
  hn::Store(density, d, pdf.v + at);
}

template <class Lobe>
HWY_INLINE void eval_lobes(const LobeMixture& m, const DirectionBatch& w, RgbBatch& value, ScalarBatch& pdf) {
  const hn::CappedTag<float, 16> wide;
  const hn::CappedTag<float, 8> narrow;
  const int lanes = static_cast<int>(hn::Lanes(wide));
  int at = 0;
  // The last eight or fewer directions do not pay for sixteen lanes.
  for (; w.count - at > 8; at += lanes) eval_vector<Lobe>(wide, m, w, at, value, pdf);
  for (; at < w.count; at += static_cast<int>(hn::Lanes(narrow))) eval_vector<Lobe>(narrow, m, w, at, value, pdf);
}

template <class Lobe>
void eval_density_of(const LobeMixture& m, const DirectionBatch& w, ScalarBatch& pdf) {
  const hn::CappedTag<float, 8> d;
  for (int at = 0; at < w.count; at += static_cast<int>(hn::Lanes(d))) {
    const auto wx = hn::Load(d, w.x + at), wy = hn::Load(d, w.y + at), wz = hn::Load(d, w.z + at);
    auto density = hn::Mul(hn::Set(d, m.cosine_share / kPi), hn::Max(wz, hn::Zero(d)));
    for (int j = 0; j < m.count; ++j) {
      const auto dx = hn::Sub(wx, hn::Set(d, m.x[j]));
      const auto dy = hn::Sub(wy, hn::Set(d, m.y[j]));
      const auto dz = hn::Sub(wz, hn::Set(d, m.z[j]));
      const auto distance_sq = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
      density = hn::MulAdd(hn::Set(d, m.density[j]), Lobe(m.bandwidth[j])(d, distance_sq), density);
    }
    hn::Store(density, d, pdf.v + at);
  }
}

void eval_density_simd(const LobeMixture& m, const DirectionBatch& w, ScalarBatch& pdf) {
  if (m.kernel == Kernel::gaussian) return eval_density_of<GaussianLobe>(m, w, pdf);
  return eval_density_of<AbelPoissonLobe>(m, w, pdf);
}

void eval_mixture_simd(const LobeMixture& m, const DirectionBatch& w, RgbBatch& value, ScalarBatch& pdf) {
  if (m.kernel == Kernel::gaussian) return eval_lobes<GaussianLobe>(m, w, value, pdf);
  return eval_lobes<AbelPoissonLobe>(m, w, value, pdf);
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

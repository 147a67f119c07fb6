// Highway compiles this file once for each instruction set.
#include "srbf/lobe_mixture.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "srbf/eval_mixture.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "srbf/simd_dispatch.h"

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

void eval_mixture(const LobeMixture& mixture, const DirectionBatch& w, RgbBatch& value, ScalarBatch& pdf) {
  VELOUR_SIMD_DISPATCH(eval_mixture_simd)(mixture, w, value, pdf);
}

}  // namespace velour
#endif

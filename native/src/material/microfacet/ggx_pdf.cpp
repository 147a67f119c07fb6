// Highway compiles this file once for each instruction set.
#include "material/microfacet/ggx_sampler.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "material/microfacet/ggx_pdf.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class D>
HWY_INLINE void pdf_of_vector(D d, const GgxPoint& point, const Vec3& spread_of, const DirectionBatch& wl, int at,
                              ScalarBatch& pdf) {
  using V = hn::Vec<D>;
  const V z = hn::Load(d, wl.z + at);
  const V sx = hn::Add(hn::Load(d, wl.x + at), hn::Set(d, point.wv.x));
  const V sy = hn::Add(hn::Load(d, wl.y + at), hn::Set(d, point.wv.y));
  const V sz = hn::Add(z, hn::Set(d, point.wv.z));
  const V xx = hn::Mul(sx, sx), yy = hn::Mul(sy, sy), zz = hn::Mul(sz, sz);
  const V length_sq = hn::Add(xx, hn::Add(yy, zz));
  const V spread = hn::MulAdd(hn::Set(d, spread_of.x), xx,
                              hn::MulAdd(hn::Set(d, spread_of.y), yy, hn::Mul(hn::Set(d, spread_of.z), zz)));
  const V ratio = hn::Div(length_sq, spread);
  const V lobe = hn::Mul(hn::Set(d, point.lobe_scale), hn::Mul(ratio, ratio));
  const V visible = hn::IfThenElseZero(hn::Gt(sz, hn::Zero(d)), lobe);  // also drops 0 / 0 of opposite directions
  const V cosine = hn::Max(z, hn::Zero(d));
  hn::Store(hn::MulAdd(hn::Set(d, point.cosine_share / kPi), cosine, visible), d, pdf.v + at);
}

void ggx_mixture_pdf_simd(const GgxPoint& point, const Vec3& spread_of, const DirectionBatch& wl, ScalarBatch& pdf) {
  const hn::CappedTag<float, 16> d;
  for (int at = 0; at < wl.count; at += static_cast<int>(hn::Lanes(d))) {
    pdf_of_vector(d, point, spread_of, wl, at, pdf);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "material/microfacet/ggx.h"

namespace velour {

HWY_EXPORT(ggx_mixture_pdf_simd);

void ggx_mixture_pdf(const GgxPoint& point, const Vec2& alpha, const DirectionBatch& wl, ScalarBatch& pdf) {
  const Vec3 spread_of(ggx_spread({1, 0, 0}, alpha), ggx_spread({0, 1, 0}, alpha), ggx_spread({0, 0, 1}, alpha));
  VELOUR_SIMD_DISPATCH(ggx_mixture_pdf_simd)(point, spread_of, wl, pdf);
}

}  // namespace velour
#endif

// Highway compiles this file once for each instruction set.
#include "brdf/formats/rgl.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/formats/rgl_positions.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

#ifndef VELOUR_BRDF_RGL_LANES
#define VELOUR_BRDF_RGL_LANES
namespace velour {

struct RglLanes {
  alignas(64) float x[kRglPositions], y[kRglPositions], z[kRglPositions];  // light, not mirrored
  alignas(64) Vec2 position[kRglPositions];
};

}  // namespace velour
#endif

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// atan2 with the polynomial of brdf_table.h, over lanes.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V arc_tangent(D d, V y, V x) {
  constexpr float kTerms[] = {-0.0161657367f, 0.0429096138f, -0.0752896400f, 0.1065626393f,
                              -0.1420889944f, 0.1999355085f, -0.3333314528f};
  const V ax = hn::Abs(x), ay = hn::Abs(y);
  const V t = hn::Div(hn::Min(ax, ay), hn::Max(hn::Max(ax, ay), hn::Set(d, 1e-37f))), s = hn::Mul(t, t);
  V p = hn::Set(d, 0.0028662257f);
  for (const float term : kTerms) p = hn::MulAdd(p, s, hn::Set(d, term));
  V angle = hn::MulAdd(hn::Mul(t, s), p, t);
  angle = hn::IfThenElse(hn::Gt(ay, ax), hn::Sub(hn::Set(d, 1.57079632679f), angle), angle);
  angle = hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, 3.14159265359f), angle), angle);
  return hn::CopySign(angle, y);
}

void positions_simd(const RglView& view, RglLanes& lanes) {
  const hn::CappedTag<float, kRglPositions> d;
  using V = hn::Vec<decltype(d)>;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0f);
  for (size_t at = 0; at < kRglPositions; at += hn::Lanes(d)) {
    const V sx = hn::MulAdd(hn::Load(d, lanes.x + at), hn::Set(d, view.flip.x), hn::Set(d, view.wv.x));
    const V sy = hn::MulAdd(hn::Load(d, lanes.y + at), hn::Set(d, view.flip.y), hn::Set(d, view.wv.y));
    const V sz = hn::Add(hn::Load(d, lanes.z + at), hn::Set(d, view.wv.z));
    const V cosine = hn::Set(d, view.cos_phi), sine = hn::Set(d, view.sin_phi);
    const V x = hn::MulAdd(sx, cosine, hn::Mul(sy, sine)), y = hn::NegMulAdd(sx, sine, hn::Mul(sy, cosine));
    const V theta = arc_tangent(d, hn::Sqrt(hn::MulAdd(sx, sx, hn::Mul(sy, sy))), sz);
    const V zenith = hn::Sqrt(hn::Min(hn::Max(hn::Mul(theta, hn::Set(d, 2.0f / kPi)), zero), one));
    const V turns = hn::MulAdd(arc_tangent(d, y, x), hn::Set(d, 0.5f / kPi), hn::Set(d, 0.5f));
    const V azimuth = hn::Sub(turns, hn::Floor(turns));
    hn::StoreInterleaved2(zenith, azimuth, d, &lanes.position[at].x);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>

namespace velour {

HWY_EXPORT(positions_simd);

void half_vector_positions(const RglView& view, std::span<const Vec3> wl, Vec2* positions) {
  RglLanes lanes{};
  for (size_t i = 0; i < wl.size(); ++i) {
    lanes.x[i] = wl[i].x;
    lanes.y[i] = wl[i].y;
    lanes.z[i] = wl[i].z;
  }
  VELOUR_SIMD_DISPATCH(positions_simd)(view, lanes);
  std::copy_n(lanes.position, wl.size(), positions);
}

}  // namespace velour
#endif

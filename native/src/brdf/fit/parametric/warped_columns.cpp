#include "brdf/fit/parametric/warped_columns.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/fit/parametric/warped_columns.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// Require Highway's namespace of the target.
#include "base/simd_dispatch.h"
#include "math/sphere/simd_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, SliceSamples::kPadding>;
using Lanes = hn::Vec<Tag>;

Lanes every(double value) { return hn::Set(Tag(), static_cast<float>(value)); }

struct Lanes3 {
  Lanes x, y, z;
};
Lanes dot(const Lanes3& a, const Lanes3& b) { return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z))); }
Lanes3 every(const Vec3d& v) { return {every(v.x), every(v.y), every(v.z)}; }

/// Broadcasts a shape to all lanes.
struct Warp {
  Lanes xx, xy, yy;
  Lanes3 offset;  // added to wl before the stretch: wv for half-space lobes
  Lanes3 center;
  Lanes bandwidth;

  Warp(const WarpedShape& s, const Vec3d& wv) {
    const Stretch stretch = stretch_from(s.stretch_a, s.stretch_b);
    xx = every(stretch.xx), xy = every(stretch.xy), yy = every(stretch.yy);
    offset = every(s.space == LobeSpace::half ? wv : Vec3d(0));
    center = every(tilted_normal(s.tilt_x, s.tilt_y));
    bandwidth = every(std::exp(s.log_bandwidth));
  }
};

/// psi at one vector of samples, and intermediate values for the derivatives.
struct Warped {
  Lanes3 y;       // before the stretch
  Lanes inverse;  // 1 / |S y|
  Lanes3 psi;
  Lanes exponent;  // bandwidth |psi - center|^2 / 2
  Lanes value;     // sqrt(weight) cos(theta) G
};

Warped warp(const Warp& w, const SliceSamples& samples, size_t i) {
  const Tag tag;
  const Lanes z = hn::Load(tag, samples.z() + i);
  Warped out;
  out.y = {hn::Add(hn::Load(tag, samples.x() + i), w.offset.x), hn::Add(hn::Load(tag, samples.y() + i), w.offset.y),
           hn::Add(z, w.offset.z)};
  const Lanes3 s = {hn::MulAdd(w.xx, out.y.x, hn::Mul(w.xy, out.y.y)),
                    hn::MulAdd(w.xy, out.y.x, hn::Mul(w.yy, out.y.y)), out.y.z};
  out.inverse = hn::Div(hn::Set(tag, 1.0f), hn::Sqrt(dot(s, s)));
  out.psi = {hn::Mul(s.x, out.inverse), hn::Mul(s.y, out.inverse), hn::Mul(s.z, out.inverse)};
  const Lanes3 apart = {hn::Sub(out.psi.x, w.center.x), hn::Sub(out.psi.y, w.center.y), hn::Sub(out.psi.z, w.center.z)};
  out.exponent = hn::Mul(hn::Mul(dot(apart, apart), hn::Set(tag, 0.5f)), w.bandwidth);
  const Lanes weight = hn::Mul(hn::Load(tag, samples.sqrt_weight() + i), z);
  out.value = hn::Mul(weight, exp_nonpositive(tag, hn::Neg(out.exponent)));
  return out;
}

void FillWarped(const WarpedShape& shape, const Vec3d& wv, const SliceSamples& samples, float* HWY_RESTRICT out) {
  const Tag tag;
  const Warp w(shape, wv);
  for (size_t i = 0; i < samples.padded(); i += hn::Lanes(tag)) hn::Store(warp(w, samples, i).value, tag, out + i);
}

/// Derivative of psi . center with respect to a change `slope` of the stretch.
Lanes stretch_slope(const Stretch& slope, const Warped& at, const Lanes3& across) {
  const Lanes x = hn::MulAdd(every(slope.xx), at.y.x, hn::Mul(every(slope.xy), at.y.y));
  const Lanes y = hn::MulAdd(every(slope.xy), at.y.x, hn::Mul(every(slope.yy), at.y.y));
  return hn::Mul(at.inverse, hn::MulAdd(across.x, x, hn::Mul(across.y, y)));
}

void FillWarpedSlopes(const WarpedShape& shape, const Vec3d& wv, const SliceSamples& samples, int count, float* value,
                      float* const out[kWarpedSlopes]) {
  const Tag tag;
  const Warp w(shape, wv);
  const TiltSlopes tilt = tilt_slopes(shape.tilt_x, shape.tilt_y);
  const Lanes3 tilt_x = every(tilt.by_x), tilt_y = every(tilt.by_y);
  const StretchSlopes stretch = stretch_slopes(shape.stretch_a, shape.stretch_b);
  for (size_t i = 0; i < samples.padded(); i += hn::Lanes(tag)) {
    const Warped at = warp(w, samples, i);
    hn::Store(at.value, tag, value + i);
    const Lanes slope = hn::Mul(at.value, w.bandwidth);
    // The component of the center orthogonal to psi: the gradient of psi . center as psi moves on the sphere.
    const Lanes t = dot(at.psi, w.center);
    const Lanes3 across = {hn::NegMulAdd(at.psi.x, t, w.center.x), hn::NegMulAdd(at.psi.y, t, w.center.y),
                           hn::NegMulAdd(at.psi.z, t, w.center.z)};
    hn::Store(hn::Neg(hn::Mul(at.value, at.exponent)), tag, out[0] + i);
    hn::Store(hn::Mul(slope, dot(at.psi, tilt_x)), tag, out[1] + i);
    hn::Store(hn::Mul(slope, stretch_slope(stretch.by_a, at, across)), tag, out[2] + i);
    if (count <= 3) continue;
    hn::Store(hn::Mul(slope, dot(at.psi, tilt_y)), tag, out[3] + i);
    hn::Store(hn::Mul(slope, stretch_slope(stretch.by_b, at, across)), tag, out[4] + i);
  }
}

void ProjectWarped(const WarpedShape& shape, const Vec3d& wv, const SliceSamples& samples,
                   const float* const residual[3], size_t stride, Projection& out) {
  const Tag tag;
  const Warp w(shape, wv);
  Lanes m0 = hn::Zero(tag), m1 = m0, m2 = m0, norm_sq = m0;
  // Whole blocks of kPadding samples, so that every instruction set uses the same samples.
  for (size_t block = 0; block < samples.padded(); block += stride * SliceSamples::kPadding) {
    for (size_t i = block; i < block + SliceSamples::kPadding; i += hn::Lanes(tag)) {
      const Lanes value = warp(w, samples, i).value;
      m0 = hn::MulAdd(value, hn::Load(tag, residual[0] + i), m0);
      m1 = hn::MulAdd(value, hn::Load(tag, residual[1] + i), m1);
      m2 = hn::MulAdd(value, hn::Load(tag, residual[2] + i), m2);
      norm_sq = hn::MulAdd(value, value, norm_sq);
    }
  }
  const auto sum = [tag](Lanes v) { return static_cast<double>(hn::GetLane(hn::SumOfLanes(tag, v))); };
  out = {{sum(m0), sum(m1), sum(m2)}, sum(norm_sq)};
}

}  // namespace velour::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

namespace {
HWY_EXPORT(FillWarped);
HWY_EXPORT(FillWarpedSlopes);
HWY_EXPORT(ProjectWarped);
}  // namespace

void fill_warped(const WarpedShape& shape, const Vec3d& wv, const SliceSamples& samples, float* out) {
  VELOUR_SIMD_DISPATCH(FillWarped)(shape, wv, samples, out);
}

void fill_warped_slopes(const WarpedShape& shape, const Vec3d& wv, const SliceSamples& samples, int count, float* value,
                        float* const out[kWarpedSlopes]) {
  VELOUR_SIMD_DISPATCH(FillWarpedSlopes)(shape, wv, samples, count, value, out);
}

Projection project_warped(const WarpedShape& shape, const Vec3d& wv, const SliceSamples& samples,
                          const float* const residual[3], size_t stride) {
  Projection out;
  VELOUR_SIMD_DISPATCH(ProjectWarped)(shape, wv, samples, residual, stride, out);
  return out;
}

}  // namespace velour
#endif  // HWY_ONCE

// Vectorized distance look-ups in a shell and points on its rays. Included once for each instruction set, by sources
// that Highway compiles for several.
#if defined(VELOUR_VOTF_SHELL_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VELOUR_VOTF_SHELL_LANES_INL_H_
#undef VELOUR_VOTF_SHELL_LANES_INL_H_
#else
#define VELOUR_VOTF_SHELL_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "votf/eval/occlusion_volume.h"
#include "votf/eval/shell_trace.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class D>
struct PlaceLanes {
  hn::Vec<D> x, y, z;
};

/// Index of the grid point before position `periods`, for `points` points at the cell centers of a period; `part`
/// receives the fraction beyond it. Any input gives a valid index.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> periodic_cell(D d, V periods, uint32_t points, V& part) {
  const hn::RebindToSigned<D> di;
  // Floats of this size and above have no fraction.
  const V fraction =
      hn::IfThenElseZero(hn::Lt(hn::Abs(periods), hn::Set(d, 0x1p23f)), hn::Sub(periods, hn::Floor(periods)));
  const V at = hn::MulAdd(fraction, hn::Set(d, static_cast<float>(points)), hn::Set(d, -0.5f)), before = hn::Floor(at);
  part = hn::Sub(at, before);
  const auto cell = hn::ConvertTo(di, before), last = hn::Set(di, static_cast<int32_t>(points) - 1);
  return hn::Min(hn::IfThenElse(hn::Lt(cell, hn::Zero(di)), last, cell), last);
}

/// Trilinear distance, in tile widths.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V distance_at(D d, const ShellTable& t, const PlaceLanes<D>& q) {
  const hn::RebindToSigned<D> di;
  V x_part, y_part;
  const auto x = periodic_cell(d, q.x, t.width, x_part);
  const auto y = periodic_cell(d, hn::Mul(q.y, hn::Set(d, t.per_aspect)), t.height, y_part);
  const auto depth = static_cast<int32_t>(t.depth), row = static_cast<int32_t>(t.row);
  const V z = hn::Min(hn::Max(hn::Mul(hn::Sub(q.z, hn::Set(d, t.bottom)), hn::Set(d, t.per_step)), hn::Zero(d)),
                      hn::Set(d, static_cast<float>(depth - 1)));
  const auto iz = hn::Min(hn::Max(hn::ConvertTo(di, z), hn::Zero(di)), hn::Set(di, depth - 2));
  const V z_part = hn::Sub(z, hn::ConvertTo(d, iz));
  const auto at = hn::Add(hn::Add(hn::Mul(y, hn::Set(di, row)), hn::Mul(x, hn::Set(di, depth))), iz);
  const auto byte = hn::Set(di, 0xff);
  // Interpolates two consecutive points along z, in one of four columns.
  const auto along_z = [&](int32_t column) HWY_ATTR {
    const auto word = hn::GatherOffset(di, reinterpret_cast<const int32_t*>(t.column + column), at);
    const V low = hn::ConvertTo(d, hn::And(word, byte)),
            high = hn::ConvertTo(d, hn::And(hn::ShiftRight<8>(word), byte));
    return hn::MulAdd(z_part, hn::Sub(high, low), low);
  };
  const V a = along_z(0), b = along_z(depth), c = along_z(row), e = along_z(row + depth);
  const V low = hn::MulAdd(x_part, hn::Sub(b, a), a), high = hn::MulAdd(x_part, hn::Sub(e, c), c);
  const V level = hn::MulAdd(y_part, hn::Sub(high, low), low);
  return hn::Mul(hn::Set(d, t.unit), hn::Sub(level, hn::Set(d, VotfVolume::kZero)));
}

template <class D>
struct RayLanes {
  hn::Vec<D> x, y, along_x, along_y, sine, cosine, curvature, scale, height;
};

/// Broadcasts one ray to all lanes.
template <class D>
HWY_INLINE RayLanes<D> ray_in_all(D d, const ShellRay& ray, float sine) {
  const auto all = [&](float x) HWY_ATTR { return hn::Set(d, x); };
  return {all(ray.place.x), all(ray.place.y),   all(ray.along.x), all(ray.along.y), all(sine),
          all(ray.cosine),  all(ray.curvature), all(ray.scale),   all(ray.height)};
}

/// atan2(far, near) / far, for arguments that are not negative and not both 0. Relative error below 5e-6, by the
/// minimax polynomial.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V angle_over_far(D d, V far, V near) {
  const auto steep = hn::Gt(far, near);
  const V longer = hn::IfThenElse(steep, far, near), tangent = hn::Div(hn::Min(far, near), longer);
  const V square = hn::Mul(tangent, tangent);
  V sum = hn::MulAdd(square, hn::Set(d, -0.014192834f), hn::Set(d, 0.059349153f));
  sum = hn::MulAdd(square, sum, hn::Set(d, -0.12300085f));
  sum = hn::MulAdd(square, sum, hn::Set(d, 0.19634373f));
  sum = hn::MulAdd(square, sum, hn::Set(d, -0.3331055f));
  const V over_tangent = hn::MulAdd(square, sum, hn::Set(d, 1.0f));
  const V rest = hn::NegMulAdd(tangent, over_tangent, hn::Set(d, 1.5707963f));
  return hn::Div(hn::IfThenElse(steep, rest, over_tangent), longer);
}

/// Points `s` meters past the crossing, with z relative to the top.
template <class D, class V = hn::Vec<D>>
HWY_INLINE PlaceLanes<D> place_on(D d, const RayLanes<D>& ray, V s) {
  const V one = hn::Set(d, 1.0f), a = hn::Mul(s, ray.sine), down = hn::Mul(s, ray.cosine);
  if (hn::AllTrue(d, hn::Eq(ray.curvature, hn::Zero(d)))) {
    return {hn::MulAdd(ray.along_x, a, ray.x), hn::MulAdd(ray.along_y, a, ray.y),
            hn::NegMulAdd(ray.scale, down, ray.height)};
  }
  // In units of the radius of the surface at the crossing: `bent` across and `b` up from the center. A ray that passes
  // beside the center is clamped at 84 degrees.
  const V bent = hn::Mul(ray.curvature, a), far = hn::Abs(bent);
  const V b = hn::Max(hn::NegMulAdd(ray.curvature, down, one), hn::Mul(hn::Set(d, 0.1f), far));
  const V fall = hn::Mul(s, hn::Sub(hn::Mul(ray.curvature, s), hn::Add(ray.cosine, ray.cosine)));
  const V deeper = hn::Div(fall, hn::Add(one, hn::Sqrt(hn::MulAdd(b, b, hn::Mul(bent, bent)))));
  const V arc = hn::Mul(a, angle_over_far(d, far, b));
  const V across = hn::IfThenElseZero(hn::Gt(b, hn::Zero(d)), arc);
  return {hn::MulAdd(ray.along_x, across, ray.x), hn::MulAdd(ray.along_y, across, ray.y),
          hn::MulAdd(ray.scale, deeper, ray.height)};
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#endif

// Highway compiles this file once for each instruction set.
#include "scene/equirectangular.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "scene/equirectangular_coordinates.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "srbf/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// atan(a) / pi for a in [0, 1]: atan(a)/a as a polynomial of degree 8 in a^2, relative error 1.6e-8 (minimax by
/// reweighted least squares).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V atan_over_pi(D d, V a) {
  const V s = hn::Mul(a, a);
  V p = hn::Set(d, 0x1.758a6cp-9f);
  p = hn::MulAdd(p, s, hn::Set(d, -0x1.0744b8p-6f));
  p = hn::MulAdd(p, s, hn::Set(d, 0x1.5dba9ep-5f));
  p = hn::MulAdd(p, s, hn::Set(d, -0x1.33603ep-4f));
  p = hn::MulAdd(p, s, hn::Set(d, 0x1.b3da4ap-4f));
  p = hn::MulAdd(p, s, hn::Set(d, -0x1.22e402p-3f));
  p = hn::MulAdd(p, s, hn::Set(d, 0x1.9972e8p-3f));
  p = hn::MulAdd(p, s, hn::Set(d, -0x1.5554a6p-2f));
  p = hn::MulAdd(p, s, hn::Set(d, 1.0f));
  return hn::Mul(hn::Mul(a, p), hn::Set(d, 0.318309886f));
}

/// atan2(y, x) / pi for y >= 0, in [0, 1]; 0 at the origin.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V upper_atan2_over_pi(D d, V y, V x) {
  const V ax = hn::Abs(x);
  const V low = hn::Min(ax, y), high = hn::Max(hn::Max(ax, y), hn::Set(d, 1e-30f));
  V angle = atan_over_pi(d, hn::Div(low, high));
  angle = hn::IfThenElse(hn::Gt(y, ax), hn::Sub(hn::Set(d, 0.5f), angle), angle);
  return hn::IfThenElse(hn::Lt(x, hn::Zero(d)), hn::Sub(hn::Set(d, 1.0f), angle), angle);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V row_dot(D d, const Mat3& m, int row, V x, V y, V z) {
  const V sum = hn::MulAdd(hn::Set(d, m[1][row]), y, hn::Mul(hn::Set(d, m[0][row]), x));
  return hn::MulAdd(hn::Set(d, m[2][row]), z, sum);
}

void coordinates_simd(const EquirectangularImage& image, const DirectionBatch& world, EquirectangularCoordinates& out) {
  const hn::CappedTag<float, 8> d;
  const hn::RebindToSigned<decltype(d)> di;
  const Mat3& m = image.world_to_image();
  const auto half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f);
  const auto width = hn::Set(d, static_cast<float>(image.width()));
  const auto height = hn::Set(d, static_cast<float>(image.height()));
  for (int at = 0; at < world.count; at += static_cast<int>(hn::Lanes(d))) {
    const auto wx = hn::Load(d, world.x + at), wy = hn::Load(d, world.y + at), wz = hn::Load(d, world.z + at);
    const auto x = row_dot(d, m, 0, wx, wy, wz), y = row_dot(d, m, 1, wx, wy, wz), z = row_dot(d, m, 2, wx, wy, wz);
    const auto r = hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y)));
    const auto turn = hn::Mul(half, upper_atan2_over_pi(d, hn::Abs(y), x));  // |phi| / (2 pi)
    const auto u = hn::Sub(half, hn::CopySign(turn, y));
    const auto theta = upper_atan2_over_pi(d, r, z);  // / pi
    // Column cells are counted from half a texel left of the image's edge, row cells from half a row above the pole.
    const auto px = hn::MulAdd(u, width, half);
    const auto py = hn::Mul(theta, height);
    const auto cx = hn::Floor(px);
    const auto cell = hn::IfThenElse(hn::Ge(cx, width), hn::Sub(cx, width), cx);
    const auto cy = hn::Min(hn::Floor(hn::Add(py, half)), height);
    hn::Store(hn::ConvertTo(di, cell), di, out.x + at);
    hn::Store(hn::ConvertTo(di, cy), di, out.y + at);
    hn::Store(hn::Sub(px, cx), d, out.fx + at);
    hn::Store(hn::Sub(hn::Add(py, half), cy), d, out.fy + at);
    const auto from_pole = hn::Min(py, hn::Sub(height, py));
    hn::Store(hn::Min(one, hn::Add(from_pole, from_pole)), d, out.pole + at);
    hn::Store(hn::Div(one, hn::Max(r, hn::Set(d, 1e-20f))), d, out.inverse_sin + at);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(coordinates_simd);

void equirectangular_coordinates(const EquirectangularImage& image, const DirectionBatch& world,
                                 EquirectangularCoordinates& out) {
  VELOUR_SIMD_DISPATCH(coordinates_simd)(image, world, out);
}

}  // namespace velour
#endif

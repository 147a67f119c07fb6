// Highway compiles this file once for each instruction set.
#include <algorithm>
#include <limits>

#include "light/equirectangular.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/equirectangular_kernels.cpp"
#include <hwy/foreach_target.h>

// Must follow foreach_target.h:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr float kLargest = std::numeric_limits<float>::max();  // radiance that overflows is clamped to it

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

void coordinates_simd(const EquirectangularImage& image, const Mat3& world_to_image, const DirectionBatch& world,
                      EquirectangularCoordinates& out) {
  const hn::CappedTag<float, 8> d;
  const hn::RebindToSigned<decltype(d)> di;
  const Mat3& m = world_to_image;
  const auto half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f);
  const auto width = hn::Set(d, static_cast<float>(image.width()));
  const auto height = hn::Set(d, static_cast<float>(image.height()));
  const auto last_column = hn::Set(di, image.width() - 1), last_row = hn::Set(di, image.height());
  for (int at = 0; at < world.count; at += static_cast<int>(hn::Lanes(d))) {
    const auto wx = hn::Load(d, world.x + at), wy = hn::Load(d, world.y + at), wz = hn::Load(d, world.z + at);
    const auto x = row_dot(d, m, 0, wx, wy, wz), y = row_dot(d, m, 1, wx, wy, wz), z = row_dot(d, m, 2, wx, wy, wz);
    const auto r = hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y)));
    const auto turn = hn::Mul(half, upper_atan2_over_pi(d, hn::Abs(y), x));  // |phi| / (2 pi)
    const auto u = hn::Sub(half, hn::CopySign(turn, y));
    const auto theta = upper_atan2_over_pi(d, r, z);  // / pi
    // Column cells start half a texel left of the image's edge, row cells half a row above the pole.
    const auto px = hn::MulAdd(u, width, half);
    const auto py = hn::Mul(theta, height);
    const auto cx = hn::Floor(px);
    const auto cell = hn::IfThenElse(hn::Ge(cx, width), hn::Sub(cx, width), cx);
    const auto cy = hn::Min(hn::Floor(hn::Add(py, half)), height);
    // Directions that are not numbers have no cell, but must not be looked up outside the image.
    hn::Store(hn::Clamp(hn::ConvertTo(di, cell), hn::Zero(di), last_column), di, out.x + at);
    hn::Store(hn::Clamp(hn::ConvertTo(di, cy), hn::Zero(di), last_row), di, out.y + at);
    hn::Store(hn::Sub(px, cx), d, out.fx + at);
    hn::Store(hn::Sub(hn::Add(py, half), cy), d, out.fy + at);
    const auto from_pole = hn::Min(py, hn::Sub(height, py));
    const auto pole = hn::Min(one, hn::Add(from_pole, from_pole));
    hn::Store(hn::Div(pole, hn::Max(r, hn::Set(d, 1e-20f))), d, out.inverse_sin + at);
  }
}

void look_up_simd(const EquirectangularImage& image, const EnvironmentPlacement& placement, const DirectionBatch& world,
                  RgbBatch& radiance, ScalarBatch& pdf) {
  EquirectangularCoordinates at;
  coordinates_simd(image, placement.world_to_image, world, at);
  const float* above[DirectionBatch::kCapacity];
  const float* below[DirectionBatch::kCapacity];
  for (int i = 0; i < world.count; ++i) {
    above[i] = &image.row(std::max(at.y[i] - 1, 0))[at.x[i]].r;
    below[i] = &image.row(std::min(at.y[i], image.height() - 1))[at.x[i]].r;
    // All texels are prefetched before the first is needed. Two adjacent ones usually share a cache line.
    __builtin_prefetch(above[i]);
    __builtin_prefetch(below[i]);
  }
  const hn::CappedTag<float, 4> d;  // all four numbers of a texel at once if there are four lanes
  for (int i = 0; i < world.count; ++i) {
    const auto fx = hn::Set(d, at.fx[i]), fy = hn::Set(d, at.fy[i]);
    alignas(16) float texel[4];
    for (size_t c = 0; c < 4; c += hn::Lanes(d)) {
      const auto a0 = hn::Load(d, above[i] + c), a1 = hn::Load(d, above[i] + 4 + c);
      const auto b0 = hn::Load(d, below[i] + c), b1 = hn::Load(d, below[i] + 4 + c);
      const auto a = hn::MulAdd(fx, hn::Sub(a1, a0), a0), b = hn::MulAdd(fx, hn::Sub(b1, b0), b0);
      hn::Store(hn::MulAdd(fy, hn::Sub(b, a), a), d, texel + c);
    }
    const auto lit = [&](float value) { return std::min(placement.strength * value, kLargest); };
    radiance.r[i] = lit(texel[0]);
    radiance.g[i] = lit(texel[1]);
    radiance.b[i] = lit(texel[2]);
    pdf.v[i] = texel[3] * at.inverse_sin[i] * image.density_scale();
  }
}

void sky_directions_simd(const Mat3& world_to_image, const float* u, const float* v, int count, DirectionBatch& world) {
  const hn::CappedTag<float, 8> d;
  const Mat3 image_to_world = glm::transpose(world_to_image);
  for (int at = 0; at < count; at += static_cast<int>(hn::Lanes(d))) {
    const auto theta = hn::Mul(hn::Load(d, v + at), hn::Set(d, kPi));
    const auto phi = hn::Mul(hn::Sub(hn::Set(d, 0.5f), hn::Load(d, u + at)), hn::Set(d, 2.0f * kPi));
    const auto r = hn::Sin(d, theta);
    const auto x = hn::Mul(r, hn::Cos(d, phi)), y = hn::Mul(r, hn::Sin(d, phi)), z = hn::Cos(d, theta);
    hn::Store(row_dot(d, image_to_world, 0, x, y, z), d, world.x + at);
    hn::Store(row_dot(d, image_to_world, 1, x, y, z), d, world.y + at);
    hn::Store(row_dot(d, image_to_world, 2, x, y, z), d, world.z + at);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(coordinates_simd);
HWY_EXPORT(look_up_simd);
HWY_EXPORT(sky_directions_simd);

void equirectangular_coordinates(const EquirectangularImage& image, const Mat3& world_to_image,
                                 const DirectionBatch& world, EquirectangularCoordinates& out) {
  VELOUR_SIMD_DISPATCH(coordinates_simd)(image, world_to_image, world, out);
}

void equirectangular_look_up(const EquirectangularImage& image, const EnvironmentPlacement& placement,
                             const DirectionBatch& world, RgbBatch& radiance, ScalarBatch& pdf) {
  VELOUR_SIMD_DISPATCH(look_up_simd)(image, placement, world, radiance, pdf);
}

void equirectangular_directions(const Mat3& world_to_image, const float* u, const float* v, int count,
                                DirectionBatch& world) {
  VELOUR_SIMD_DISPATCH(sky_directions_simd)(world_to_image, u, v, count, world);
}

}  // namespace velour
#endif

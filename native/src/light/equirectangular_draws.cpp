// Highway compiles this file once for each instruction set.
#include "light/equirectangular.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "light/equirectangular_draws.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Relative position of `u` between `low` and `high`, in [0, 1].
template <class D, class V = hn::Vec<D>>
HWY_INLINE V place_between(D d, V u, V low, V high) {
  const V share = hn::Div(hn::Sub(u, low), hn::Max(hn::Sub(high, low), hn::Set(d, 1e-30f)));
  return hn::Min(hn::Max(share, hn::Zero(d)), hn::Set(d, 1.0f));
}

/// Inverse cdf at `u` of the density on [0, 1] that runs linearly from `a` to `b`; u if both are 0.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V invert_linear(D d, V a, V b, V u) {
  const V one = hn::Set(d, 1.0f);
  // Squares of what is scaled neither overflow nor vanish. Usual values keep their bits.
  const V largest = hn::Max(a, b);
  const auto usual = hn::And(hn::Gt(largest, hn::Set(d, 1e-16f)), hn::Lt(largest, hn::Set(d, 1e16f)));
  const V scale = hn::IfThenElse(usual, one, hn::Div(one, hn::Max(largest, hn::Set(d, 1e-37f))));
  a = hn::Mul(a, scale);
  b = hn::Mul(b, scale);
  // Root of a t + (b - a) t^2 / 2 = u (a + b) / 2 in the form without cancellation.
  const V sum = hn::Add(a, b);
  const V root = hn::Sqrt(hn::MulAdd(hn::Mul(u, b), b, hn::Mul(hn::Mul(hn::Sub(one, u), a), a)));
  const V bottom = hn::Add(a, root);
  const auto some = hn::And(hn::Gt(sum, hn::Zero(d)), hn::Gt(bottom, hn::Zero(d)));
  const V t = hn::Min(hn::Div(hn::Mul(u, sum), hn::IfThenElse(some, bottom, one)), one);
  return hn::IfThenElse(some, t, u);
}

/// The cell of `cdf` that contains `u`; the search starts at `cell`, the guide's entry.
template <class DI, class V, class VI = hn::Vec<DI>>
HWY_INLINE VI find_cells(DI di, const float* cdf, VI cell, int cells, V u) {
  const hn::RebindToFloat<DI> d;
  const VI one = hn::Set(di, 1), last = hn::Set(di, cells - 1);
  for (;;) {  // u * cells may have been rounded up
    const auto over = hn::And(hn::RebindMask(di, hn::Gt(hn::GatherIndex(d, cdf, cell), u)), hn::Gt(cell, hn::Zero(di)));
    if (hn::AllFalse(di, over)) break;
    cell = hn::IfThenElse(over, hn::Sub(cell, one), cell);
  }
  for (;;) {
    const V next = hn::GatherIndex(d, cdf, hn::Add(cell, one));
    const auto under = hn::And(hn::RebindMask(di, hn::Le(next, u)), hn::Lt(cell, last));
    if (hn::AllFalse(di, under)) return cell;
    cell = hn::IfThenElse(under, hn::Add(cell, one), cell);
  }
}

void draw_rows_simd(const MarginalTable& table, EquirectangularDraws& draws, int count) {
  const hn::CappedTag<float, 8> d;
  const hn::RebindToSigned<decltype(d)> di;
  using V = hn::Vec<decltype(d)>;
  const int bands = table.height + 1;
  const V zero = hn::Zero(d), half = hn::Set(d, 0.5f), one = hn::Set(d, 1.0f);
  const V height = hn::Set(d, static_cast<float>(table.height));
  for (int at = 0; at < count; at += static_cast<int>(hn::Lanes(d))) {
    // Samples a band between two rows, one of the two in proportion to their nodes, and the position in the band by
    // that row's weight, which falls linearly to 0 at the other row: together the bilinear density. All three come from
    // v, so that neighbors in u remain neighbors in azimuth.
    const V v = hn::Load(d, draws.v + at);
    const auto guided =
        hn::Min(hn::ConvertTo(di, hn::Mul(v, hn::Set(d, static_cast<float>(bands)))), hn::Set(di, bands - 1));
    const auto band = find_cells(di, table.cdf, hn::GatherIndex(di, table.guide, guided), bands, v);
    const V low = hn::GatherIndex(d, table.cdf, band), high = hn::GatherIndex(d, table.cdf + 1, band);
    const V above = hn::GatherIndex(d, table.node, band), below = hn::GatherIndex(d, table.node + 1, band);
    const V in_band = hn::Min(place_between(d, v, low, high), hn::Set(d, 0x1.fffffep-1f));
    const V split = hn::Div(above, hn::Max(hn::Add(above, below), hn::Set(d, 1e-30f)));
    const auto lower = hn::Ge(in_band, split);
    const V rest = hn::IfThenElse(lower, hn::Div(hn::Sub(in_band, split), hn::Sub(one, split)),
                                  hn::Sub(one, hn::Div(in_band, split)));
    const V root = hn::Sqrt(hn::Min(hn::Max(rest, zero), one));
    const V t = hn::IfThenElse(lower, root, hn::Sub(one, root));
    // The bands at the poles are half as high.
    const V number = hn::ConvertTo(d, band);
    const V inside = hn::Add(hn::Sub(number, half), t);
    const V bottom = hn::MulAdd(half, t, hn::Sub(height, half));
    const V line =
        hn::IfThenElse(hn::Eq(number, zero), hn::Mul(half, t), hn::IfThenElse(hn::Eq(number, height), bottom, inside));
    hn::Store(hn::Div(line, height), d, draws.v + at);
    const auto row = hn::Sub(band, hn::IfThenElse(hn::RebindMask(di, lower), hn::Zero(di), hn::Set(di, 1)));
    hn::Store(hn::Min(hn::Max(row, hn::Zero(di)), hn::Set(di, table.height - 1)), di, draws.row + at);
  }
}

void draw_columns_simd(int width, EquirectangularDraws& draws, int count) {
  const hn::CappedTag<float, 8> d;
  const auto scale = hn::Set(d, static_cast<float>(width));
  for (int at = 0; at < count; at += static_cast<int>(hn::Lanes(d))) {
    const auto load = [&](const float* values) { return hn::Load(d, values + at); };
    const auto in_cell = place_between(d, load(draws.u), load(draws.low), load(draws.high));
    const auto t = invert_linear(d, load(draws.left), load(draws.right), in_cell);
    const auto column = hn::Add(hn::Sub(load(draws.cell), hn::Set(d, 0.5f)), t);
    hn::Store(hn::Div(column, scale), d, draws.u + at);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(draw_rows_simd);
HWY_EXPORT(draw_columns_simd);

void draw_rows(const MarginalTable& table, EquirectangularDraws& draws, int count) {
  VELOUR_SIMD_DISPATCH(draw_rows_simd)(table, draws, count);
}

void draw_columns(int width, EquirectangularDraws& draws, int count) {
  VELOUR_SIMD_DISPATCH(draw_columns_simd)(width, draws, count);
}

}  // namespace velour
#endif

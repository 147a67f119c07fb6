// Highway compiles this file once for each instruction set.
#include "btf/relief_march.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "btf/relief_march.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "srbf/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
constexpr float kShortest = 1.0f / 1024;
using Lanes = hn::CappedTag<float, 16>;

/// A coordinate on the grid: the texel at or below it and how far it is to the next.
template <class D>
struct Place {
  hn::Vec<hn::RebindToSigned<D>> texel;
  hn::Vec<D> part;
};

template <class D, class V = hn::Vec<D>>
HWY_INLINE Place<D> place_of(D d, V coordinate, float size) {
  const V n = hn::Set(d, size);
  const V periods = hn::Floor(hn::Mul(coordinate, hn::Set(d, 1 / size)));
  // Rounding may leave the ends of the period: the last texel then, and a part of 0 or 1.
  const V inside = hn::Max(hn::NegMulAdd(periods, n, coordinate), hn::Zero(d));
  const V texel = hn::Min(hn::Floor(inside), hn::Set(d, size - 1));
  return {hn::ConvertTo(hn::RebindToSigned<D>(), texel), hn::Sub(inside, texel)};
}

template <class V>
HWY_INLINE V between(V a, V b, V part) {
  return hn::MulAdd(hn::Sub(b, a), part, a);
}

/// Of the surface at `when`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V surface_at(D d, const ReliefMarch& m, V when) {
  const hn::RebindToSigned<D> di;
  const auto along = [&](float from, float way) { return hn::MulAdd(when, hn::Set(d, way), hn::Set(d, from)); };
  const auto x = place_of(d, along(m.from.x, m.way.x), static_cast<float>(m.width));
  const auto y = place_of(d, along(m.from.y, m.way.y), static_cast<float>(m.height));
  const auto index = hn::Add(hn::Mul(y.texel, hn::Set(di, static_cast<int32_t>(m.width + 1))), x.texel);
  const float* above = m.heights + m.width + 1;
  const V low = between(hn::GatherIndex(d, m.heights, index), hn::GatherIndex(d, m.heights + 1, index), x.part);
  const V high = between(hn::GatherIndex(d, above, index), hn::GatherIndex(d, above + 1, index), x.part);
  return between(low, high, y.part);
}

/// A time and how far the ray is above the surface then.
struct Sounding {
  float when, gap;
};

/// The first is above the surface, the second is not. Where their chord meets it, once more: a step may cross the edges
/// of texels, at which the surface bends.
HWY_INLINE float refined(const ReliefMarch& m, Sounding above, Sounding below) {
  const hn::CappedTag<float, 1> d;
  const auto chord = [&] { return above.when + (below.when - above.when) * (above.gap / (above.gap - below.gap)); };
  const float when = chord();
  const float surface = hn::GetLane(surface_at(d, m, hn::Set(d, when)));
  const Sounding between_them{when, m.top - when * m.fall - surface};
  (between_them.gap > 0 ? above : below) = between_them;
  return chord();
}

float meeting(const ReliefMarch& m) {
  const Lanes d;
  const auto lanes = static_cast<float>(hn::Lanes(d));
  // Rays along the plane would take for ever.
  const float step = std::max(1 / std::max({std::abs(m.way.x), std::abs(m.way.y), 1e-3f}), kShortest);
  HWY_ALIGN float gaps[16];
  float gap_before = 0, earlier = 0;
  for (float first = 0;; first += lanes) {
    // The last step ends where the ray does.
    const auto when =
        hn::Min(hn::Mul(hn::Set(d, step), hn::Add(hn::Iota(d, 0.0f), hn::Set(d, first))), hn::Set(d, 1.0f));
    const auto ray = hn::NegMulAdd(when, hn::Set(d, m.fall), hn::Set(d, m.top));
    const auto gap = hn::Sub(ray, surface_at(d, m, when));
    const intptr_t met = hn::FindFirstTrue(d, hn::Le(gap, hn::Zero(d)));
    hn::Store(gap, d, gaps);
    if (met >= 0) {
      const float gap_met = gaps[met];
      if (met > 0) {
        gap_before = gaps[met - 1];
        earlier = step * (first + static_cast<float>(met - 1));
      }
      const float now = std::min(step * (first + static_cast<float>(met)), 1.0f);
      if (!(gap_before > 0)) return now;  // at the start
      return refined(m, {earlier, gap_before}, {now, gap_met});
    }
    const float last = first + lanes - 1;
    if (step * last >= 1) return 1;
    gap_before = gaps[static_cast<size_t>(lanes) - 1];
    earlier = step * last;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(meeting);

float first_meeting(const ReliefMarch& march) { return VELOUR_SIMD_DISPATCH(meeting)(march); }

}  // namespace velour
#endif

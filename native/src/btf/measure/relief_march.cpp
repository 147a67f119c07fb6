// Highway compiles this file once for each instruction set.
#include "btf/measure/relief.h"

#include <algorithm>
#include <bit>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "btf/measure/relief_march.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
constexpr float kMaxLines = 1024;
constexpr float kLong = 24;
constexpr float kShortest = 1e-6f;  // extents below this count as zero
constexpr size_t kMaxLanes = 16;
using Lanes = hn::CappedTag<float, kMaxLanes>;

/// The grid lines of one orientation that a ray crosses, starting with the last one before its origin. `across` is the
/// axis that counts them, `along` the coordinate on them.
struct Lines {
  Lines(float from, float way, float start_along, float way_along_, const Period& across_, const Period& along_)
      : from_along(start_along), way_along(way_along_), across(across_), along(along_) {
    // Branch-free, because the sign of the direction is unpredictable.
    step = std::copysign(1.0f, way);
    line = step * std::floor(step * from);
    rate = std::max(std::abs(way), kShortest);
    period = 1 / rate;
    first = std::abs(line - from) * -period;
    last = std::ceil((1 - first) * std::abs(way)) + 1;
    if (rate > kMaxLines) take_every(std::ceil(rate * (1 / kMaxLines)));
  }
  void take_every(float n) {
    step *= n;
    period *= n;
    rate /= n;
  }
  /// Number of the last line before `when`, until which the ray is known to be above the surface.
  float number_before(float when) const { return std::max(std::floor((when - first) * rate - 1e-2f), 0.0f); }

  float line, step, from_along, way_along;
  float first, period, rate;  // times; `rate` in lines per unit of time
  float last;                 // number of a line beyond the end
  const Period &across, &along;
};

/// State of a ray at one line per lane, and at the last line before those.
struct Crossings {
  static constexpr size_t kFirst = kMaxLanes;  // keeps vectors aligned

  bool none_met() const { return met == kFirst + hn::Lanes(Lanes()); }
  float end() const { return when[met]; }
  size_t before(float end) const {
    const Lanes d;
    return kFirst - 1 + hn::CountTrue(d, hn::Lt(hn::Load(d, when + kFirst), hn::Set(d, end)));
  }

  // The last entry is the first line that has not been tested.
  HWY_ALIGN float when[2 * kMaxLanes + 1];
  HWY_ALIGN float gap[2 * kMaxLanes + 1];  // height of the ray above the surface
  size_t met;  // index of the first crossing that is not above the surface; one past the last if all are
};

/// Converts an integral float in [0, 2^22] to an integer.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> whole(D d, V number) {
  const hn::RebindToSigned<D> di;
  return hn::Sub(hn::BitCast(di, hn::Add(number, hn::Set(d, 8388608.0f))), hn::Set(di, 0x4b000000));
}

/// Index of the first true lane; the number of lanes if there is none.
template <class D, class M>
HWY_INLINE size_t first_true(D d, M mask) {
  const intptr_t first = hn::FindFirstTrue(d, mask);
  return first < 0 ? hn::Lanes(d) : static_cast<size_t>(first);
}

/// Wraps `at` into the period, [0, extent].
template <class D, class V = hn::Vec<D>>
HWY_INLINE V wrapped(D d, V at, const Period& period) {
  const V extent = hn::Set(d, period.extent), periods = hn::Floor(hn::Mul(at, hn::Set(d, period.inverse)));
  return hn::Min(hn::Max(hn::NegMulAdd(periods, extent, at), hn::Zero(d)), extent);
}

/// Tests the lines from `number` on. `kAlongX`: the lines run along x.
template <bool kAlongX>
HWY_INLINE void cross(const Lines& lines, const HeightWords& heights, float number, Crossings& crossings) {
  const Lanes d;
  const hn::RebindToUnsigned<Lanes> du;
  const hn::RebindToSigned<Lanes> di;
  // Lanes beyond the end repeat one line: their result is known, but they still have to read.
  const auto n = hn::Min(hn::Add(hn::Iota(d, 0.0f), hn::Set(d, number)), hn::Set(d, lines.last));
  const auto when = hn::MulAdd(n, hn::Set(d, lines.period), hn::Set(d, lines.first));
  const auto line = wrapped(d, hn::MulAdd(n, hn::Set(d, lines.step), hn::Set(d, lines.line)), lines.across);
  const auto along =
      wrapped(d, hn::MulAdd(when, hn::Set(d, lines.way_along), hn::Set(d, lines.from_along)), lines.along);
  // At the end of the period: the last corner, with a fraction of 1.
  const auto corner = hn::Min(hn::Floor(along), hn::Set(d, lines.along.extent - 1));
  const auto stride = hn::Set(di, static_cast<int32_t>(heights.stride));
  const auto across = whole(d, line), place = whole(d, corner);
  const auto index = kAlongX ? hn::Add(hn::Mul(across, stride), place) : hn::Add(hn::Mul(place, stride), across);
  const auto word = hn::BitCast(di, hn::GatherIndex(du, heights.word.data(), index));
  const auto mask = hn::Set(di, kHeightRange);
  const auto low = hn::ConvertTo(d, hn::And(word, mask));
  const auto high = hn::ConvertTo(d, hn::And(hn::ShiftRight < kAlongX ? 10 : 20 > (word), mask));
  const auto surface = hn::MulAdd(hn::Sub(high, low), hn::Sub(along, corner), low);
  const auto gap =
      hn::Sub(hn::NegMulAdd(when, hn::Set(d, float{kHeightRange}), hn::Set(d, float{kHeightRange})), surface);
  const size_t count = hn::Lanes(d);
  hn::Store(when, d, crossings.when + Crossings::kFirst);
  hn::Store(gap, d, crossings.gap + Crossings::kFirst);
  crossings.when[Crossings::kFirst + count] = lines.first + (number + static_cast<float>(count)) * lines.period;
  crossings.gap[Crossings::kFirst + count] = 0;
  crossings.met = Crossings::kFirst + first_true(d, hn::Le(gap, hn::Zero(d)));
}

/// Tests the next lines.
template <bool kAlongX>
HWY_INLINE void cross_next(const Lines& lines, const HeightWords& heights, float& number, Crossings& crossings) {
  const size_t count = hn::Lanes(Lanes()), last = Crossings::kFirst + count - 1;
  crossings.when[Crossings::kFirst - 1] = crossings.when[last];
  crossings.gap[Crossings::kFirst - 1] = crossings.gap[last];
  number += static_cast<float>(count);
  cross<kAlongX>(lines, heights, number, crossings);
}

/// A time until which the ray is above everything around it.
HWY_INLINE float clear_until(const HeightWords& heights, const ReliefMarch& m) {
  const hn::CappedTag<float, 8> d;
  const hn::RebindToSigned<decltype(d)> di;
  constexpr auto kCells = static_cast<float>(HeightWords::kBlock);
  const float step = kCells / std::max({std::abs(m.way.x), std::abs(m.way.y), kShortest});
  const auto when = hn::Mul(hn::Iota(d, 0.0f), hn::Set(d, step));
  const auto block = [&](float from, float way, const Period& period) {
    const auto at = wrapped(d, hn::MulAdd(when, hn::Set(d, way), hn::Set(d, from)), period);
    return whole(d, hn::Floor(hn::Mul(hn::Min(at, hn::Set(d, period.extent - 1)), hn::Set(d, 1 / kCells))));
  };
  const auto x = block(m.from.x, m.way.x, heights.columns), y = block(m.from.y, m.way.y, heights.rows);
  const auto index = hn::Add(hn::Mul(y, hn::Set(di, static_cast<int32_t>(heights.blocks))), x);
  const auto lid = hn::GatherIndex(d, heights.lid.data(), index);
  // Height at the end of each step.
  const auto ray =
      hn::NegMulAdd(hn::Add(when, hn::Set(d, step)), hn::Set(d, float{kHeightRange}), hn::Set(d, float{kHeightRange}));
  return static_cast<float>(first_true(d, hn::Le(ray, lid))) * step;
}

/// Interpolates the time between the last crossing of either kind above the surface and the first one that is not.
HWY_INLINE float meeting_between(const Crossings (&at)[2], size_t next) {
  const float end = at[next].end(), below = at[next].gap[at[next].met];
  const size_t place[] = {at[0].before(end), at[1].before(end)};
  const size_t last = at[1].when[place[1]] > at[0].when[place[0]];
  const float start = at[last].when[place[last]], above = at[last].gap[place[last]];
  return std::max(start + (end - start) * (above / (above - below)), 0.0f);
}

HWY_FLATTEN Vec2 meeting(const HeightWords& heights, const ReliefMarch& m) {
  const Lines columns(m.from.x, m.way.x, m.from.y, m.way.y, heights.columns, heights.rows);
  const Lines rows(m.from.y, m.way.y, m.from.x, m.way.x, heights.rows, heights.columns);
  Crossings at[2];
  // Sentinel before the first line, in case rounding puts that line below the surface.
  for (Crossings& a : at) {
    a.when[Crossings::kFirst - 1] = -1;
    a.gap[Crossings::kFirst - 1] = 1;
  }
  const float clear = m.high && std::max(columns.rate, rows.rate) > kLong ? clear_until(heights, m) : 0.0f;
  float column = columns.number_before(clear), row = rows.number_before(clear);
  cross<false>(columns, heights, column, at[0]);
  cross<true>(rows, heights, row, at[1]);
  for (;;) {
    // An index instead of a branch, because the outcome is unpredictable.
    const size_t next = at[1].end() < at[0].end();
    if (!at[next].none_met() || !std::isfinite(at[next].end())) return m.from + meeting_between(at, next) * m.way;
    if (next == 0) {
      cross_next<false>(columns, heights, column, at[0]);
    } else {
      cross_next<true>(rows, heights, row, at[1]);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

HWY_EXPORT(meeting);

HeightWords::HeightWords(uint32_t width, uint32_t height, const std::vector<float>& part)
    : columns(width), rows(height), stride(width + 1), blocks((width + kBlock - 1) / kBlock) {
  const auto at = [&](uint32_t x, uint32_t y) {
    return static_cast<uint32_t>(std::lround(part[size_t{y % height} * width + x % width] * kHeightRange));
  };
  for (uint32_t y = 0; y <= height; ++y) {
    for (uint32_t x = 0; x <= width; ++x) word.push_back(at(x, y) | at(x + 1, y) << 10 | at(x, y + 1) << 20);
  }
  for (uint32_t y = 0; y < height; y += kBlock) {
    for (uint32_t x = 0; x < width; x += kBlock) {
      uint32_t greatest = 0;
      // kBlock cells on each side, and the far corner of the last cell.
      for (uint32_t j = 0; j <= 3 * kBlock; ++j) {
        for (uint32_t i = 0; i <= 3 * kBlock; ++i) {
          greatest = std::max(greatest, at(x + i + kBlock * (width - 1), y + j + kBlock * (height - 1)));
        }
      }
      lid.push_back(static_cast<float>(greatest));
    }
  }
}

Vec2 first_meeting(const HeightWords& heights, const ReliefMarch& march) {
  return VELOUR_SIMD_DISPATCH(meeting)(heights, march);
}

}  // namespace velour
#endif

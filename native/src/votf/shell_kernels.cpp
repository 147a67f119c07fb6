// Highway compiles this file once for each instruction set.
#include "votf/shell_kernels.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "votf/shell_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "srbf/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Few = hn::CappedTag<float, 4>;  // gathers of more lanes than there are rays cost for nothing
using Many = hn::CappedTag<float, 16>;
constexpr size_t kLongest = 16;

template <class D>
struct PlaceLanes {
  hn::Vec<D> x, y, z;
};

/// The point before `periods`, of `points` in the middles of as many cells of a period, and how far beyond it. Any
/// number gives a point there is.
template <class D, class V = hn::Vec<D>>
HWY_INLINE hn::Vec<hn::RebindToSigned<D>> periodic_cell(D d, V periods, uint32_t points, V& part) {
  const hn::RebindToSigned<D> di;
  // Beyond, a float has no room for a fraction.
  const V fraction =
      hn::IfThenElseZero(hn::Lt(hn::Abs(periods), hn::Set(d, 0x1p23f)), hn::Sub(periods, hn::Floor(periods)));
  const V at = hn::MulAdd(fraction, hn::Set(d, static_cast<float>(points)), hn::Set(d, -0.5f)), before = hn::Floor(at);
  part = hn::Sub(at, before);
  const auto cell = hn::ConvertTo(di, before), last = hn::Set(di, static_cast<int32_t>(points) - 1);
  return hn::Min(hn::IfThenElse(hn::Lt(cell, hn::Zero(di)), last, cell), last);
}

/// Trilinear, widths.
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
  // Two points that follow each other along z, in one of four columns.
  const auto along_z = [&](int32_t column) HWY_ATTR {
    const auto word = hn::GatherOffset(di, reinterpret_cast<const int32_t*>(t.column + column), at);
    const V low = hn::ConvertTo(d, hn::And(word, byte)),
            high = hn::ConvertTo(d, hn::And(hn::ShiftRight<8>(word), byte));
    return hn::MulAdd(z_part, hn::Sub(high, low), low);
  };
  const V a = along_z(0), b = along_z(depth), c = along_z(row), e = along_z(row + depth);
  const V low = hn::MulAdd(x_part, hn::Sub(b, a), a), high = hn::MulAdd(x_part, hn::Sub(e, c), c);
  const V level = hn::MulAdd(y_part, hn::Sub(high, low), low);
  return hn::Mul(hn::Set(d, t.unit), hn::Sub(level, hn::Set(d, OcclusionVolume::kZero)));
}

template <class D>
struct RayLanes {
  hn::Vec<D> x, y, along_x, along_y, sine, cosine, curvature, scale;
};

/// Angle / tangent for angles up to about 1: the series of the arc tangent.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V arc_over_tangent(D d, V tangent) {
  const V square = hn::Mul(tangent, tangent);
  V sum = hn::NegMulAdd(square, hn::Set(d, 1.0f / 7), hn::Set(d, 0.2f));
  sum = hn::NegMulAdd(square, sum, hn::Set(d, 1.0f / 3));
  return hn::NegMulAdd(square, sum, hn::Set(d, 1.0f));
}

/// From the top.
template <class D, class V = hn::Vec<D>>
HWY_INLINE PlaceLanes<D> place_on(D d, const RayLanes<D>& ray, V s) {
  const V one = hn::Set(d, 1.0f), a = hn::Mul(s, ray.sine), down = hn::Mul(s, ray.cosine);
  if (hn::AllTrue(d, hn::Eq(ray.curvature, hn::Zero(d)))) {
    return {hn::MulAdd(ray.along_x, a, ray.x), hn::MulAdd(ray.along_y, a, ray.y), hn::Neg(hn::Mul(ray.scale, down))};
  }
  // In radii of the top: `bent` across and `b` up from the centre. A ray that passes beside the centre further than 84
  // degrees on is held there.
  const V bent = hn::Mul(ray.curvature, a), far = hn::Abs(bent);
  const V b = hn::Max(hn::NegMulAdd(ray.curvature, down, one), hn::Mul(hn::Set(d, 0.1f), far));
  const V fall = hn::Mul(s, hn::Sub(hn::Mul(ray.curvature, s), hn::Add(ray.cosine, ray.cosine)));
  const V deeper = hn::Div(fall, hn::Add(one, hn::Sqrt(hn::MulAdd(b, b, hn::Mul(bent, bent)))));
  const V per_b = hn::Div(one, b);
  const V arc = hn::Mul(hn::Mul(a, per_b), arc_over_tangent(d, hn::Min(one, hn::Mul(far, per_b))));
  const V across = hn::IfThenElseZero(hn::Gt(b, hn::Zero(d)), arc);
  return {hn::MulAdd(ray.along_x, across, ray.x), hn::MulAdd(ray.along_y, across, ray.y), hn::Mul(ray.scale, deeper)};
}

/// Rays side by side that are on their way.
struct Marches {
  enum Field : size_t {
    kX,
    kY,
    kAlongX,
    kAlongY,
    kSine,
    kCosine,
    kCurvature,
    kScale,
    kOffset,
    kWay,
    kPerSpeed,
    kEnd,
    kOwn,
    kBegin,
    kS,
    kFree,
    kStep,
    kSkipped,
    kFields
  };
  alignas(64) float field[kFields][kWaysTogether + kLongest];
  alignas(64) uint32_t number[kWaysTogether + kLongest];

  void take(size_t i, const ShellWay& from, size_t of) {
    const ShellRay& ray = from.ray;
    const float way = from.end < from.begin ? -1.0f : 1.0f;
    const float values[kFields] = {ray.place.x,
                                   ray.place.y,
                                   ray.along.x,
                                   ray.along.y,
                                   from.sine,
                                   ray.cosine,
                                   ray.curvature,
                                   ray.scale,
                                   from.offset,
                                   way,
                                   way / from.speed,
                                   from.end,
                                   from.own,
                                   from.begin,
                                   from.begin,
                                   0,
                                   0,
                                   0};
    for (size_t k = 0; k < kFields; ++k) field[k][i] = values[k];
    number[i] = static_cast<uint32_t>(of);
  }
};

template <class D>
HWY_INLINE RayLanes<D> rays_of(D d, const Marches& m, size_t at) {
  const auto of = [&](Marches::Field k) HWY_ATTR { return hn::LoadU(d, m.field[k] + at); };
  return {of(Marches::kX),    of(Marches::kY),      of(Marches::kAlongX),    of(Marches::kAlongY),
          of(Marches::kSine), of(Marches::kCosine), of(Marches::kCurvature), of(Marches::kScale)};
}

/// What rays carry from look to look.
template <class D>
struct March {
  using V = hn::Vec<D>;
  using Lanes = hn::Mask<D>;
  V way, per_speed, end, own;       // way: 1 onwards, -1 back; metres a width
  V begin, s, free, step, skipped;  // the last look was `step` before, in widths, and `free` of any surface
  Lanes active, met;

  /// Goes on from a place `distance` from the structure.
  HWY_INLINE void look(D d, const ShellTable& t, V distance) {
    const V least = hn::Set(d, kLeastShellStep * t.pitch);
    Lanes within = hn::And(active, hn::Le(distance, hn::Set(d, kWithinShell * t.pitch)));
    Lanes goes = hn::AndNot(within, active);
    const Lanes on_own = hn::And(active, hn::Gt(own, hn::Zero(d)));
    if (!hn::AllFalse(d, on_own)) within = hn::AndNot(leave_own(d, within, on_own, distance, least), within);
    if (!hn::AllFalse(d, within)) meet(d, within, distance);
    go_on(d, goes, distance, least);
  }

 private:
  /// Which rays stay where they are still in the structure that they start on.
  HWY_INLINE Lanes leave_own(D d, Lanes within, Lanes on_own, V distance, V least) {
    const Lanes stays = hn::And(within, on_own), out = hn::AndNot(within, on_own);
    begin = hn::IfThenElse(out, s, begin);
    const V skip = hn::MulAdd(hn::Max(hn::Abs(distance), least), hn::Abs(per_speed), skipped);
    const Lanes too_deep = hn::And(stays, hn::Ge(skip, own));
    skipped = hn::IfThenElse(stays, skip, skipped);
    s = hn::IfThenElse(stays, hn::IfThenElse(too_deep, begin, hn::MulAdd(way, skip, begin)), s);
    own = hn::IfThenElse(hn::Or(out, too_deep), hn::Zero(d), own);
    return stays;
  }

  /// Between the two looks, where the distance falls to nothing.
  HWY_INLINE void meet(D d, Lanes meets, V distance) {
    const V part = hn::Min(hn::Set(d, 1.0f), hn::Div(distance, hn::Sub(distance, free)));
    const V at = hn::NegMulAdd(hn::Mul(per_speed, step), part, s);
    s = hn::IfThenElse(hn::AndNot(hn::Eq(step, hn::Zero(d)), meets), at, s);
    met = hn::Or(met, meets);
    active = hn::AndNot(meets, active);
  }

  HWY_INLINE void go_on(D d, Lanes goes, V distance, V least) {
    const V zero = hn::Zero(d);
    // Between the two looks there may be something: back to what is free for certain.
    const Lanes doubts = hn::And(goes, hn::Lt(hn::Add(free, distance), step)), trusts = hn::AndNot(doubts, goes);
    const V back = hn::NegMulAdd(per_speed, hn::Sub(step, free), s);
    V next_step = hn::Mul(hn::Set(d, kShellStride), hn::Max(distance, least));
    V next = hn::MulAdd(per_speed, next_step, s);
    const Lanes ends = hn::And(trusts, hn::Ge(hn::Mul(hn::Sub(next, end), way), zero));
    if (!hn::AllFalse(d, ends)) {
      // The last look is at the end, unless all before it is free for certain.
      const V certain = hn::MulAdd(per_speed, hn::Max(distance, least), s);
      active = hn::AndNot(hn::And(ends, hn::Ge(hn::Mul(hn::Sub(certain, end), way), zero)), active);
      next_step = hn::IfThenElse(ends, hn::Div(hn::Sub(end, s), per_speed), next_step);
      next = hn::IfThenElse(ends, end, next);
    }
    s = hn::IfThenElse(doubts, back, hn::IfThenElse(trusts, next, s));
    step = hn::IfThenElse(doubts, free, hn::IfThenElse(trusts, next_step, step));
    free = hn::IfThenElse(trusts, hn::Max(distance, least), free);
  }
};

constexpr int kLooks = 4;  // of all rays before those that have ended make room

/// Writes what has become of the rays of a vector that have ended.
template <class D>
HWY_INLINE void report(D d, const ShellTable& t, const RayLanes<D>& rays, const March<D>& m, hn::Mask<D> ended,
                       const uint32_t* number, ShellHit* hits) {
  alignas(64) float x[kLongest] = {}, y[kLongest] = {}, z[kLongest] = {}, s[kLongest] = {}, begin[kLongest] = {};
  uint8_t ended_bits[8] = {}, met_bits[8] = {};
  const PlaceLanes<D> place = place_on(d, rays, m.s);
  hn::Store(place.x, d, x);
  hn::Store(place.y, d, y);
  hn::Store(hn::Add(place.z, hn::Set(d, t.top)), d, z);
  hn::Store(m.s, d, s);
  hn::Store(m.begin, d, begin);
  hn::StoreMaskBits(d, ended, ended_bits);
  hn::StoreMaskBits(d, m.met, met_bits);
  for (size_t i = 0; i < hn::Lanes(d); ++i) {
    if ((ended_bits[i / 8] >> i % 8 & 1) == 0) continue;
    hits[number[i]] = {(met_bits[i / 8] >> i % 8 & 1) != 0, begin[i], s[i], {x[i], y[i], z[i]}};
  }
}

/// As many looks for the vector of rays at `at`, of `count`. Those that have not ended go to `left` and on; how many.
template <class D>
HWY_INLINE size_t march_some(D d, const ShellTable& t, Marches& all, size_t at, size_t count, size_t left, bool last,
                             ShellHit* hits) {
  const hn::RebindToUnsigned<D> du;
  const auto of = [&](Marches::Field k) HWY_ATTR { return hn::LoadU(d, all.field[k] + at); };
  const RayLanes<D> rays = rays_of(d, all, at);
  const auto valid = hn::FirstN(d, count - at);
  March<D> m{of(Marches::kWay),           of(Marches::kPerSpeed),
             of(Marches::kEnd),           of(Marches::kOwn),
             of(Marches::kBegin),         of(Marches::kS),
             of(Marches::kFree),          of(Marches::kStep),
             of(Marches::kSkipped),       valid,
             hn::MaskFromVec(hn::Zero(d))};
  const auto top = hn::Set(d, t.top), offset = of(Marches::kOffset);
  for (int i = 0; i < kLooks && !hn::AllFalse(d, m.active); ++i) {
    PlaceLanes<D> place = place_on(d, rays, m.s);
    place.z = hn::Add(place.z, top);
    m.look(d, t, hn::Sub(distance_at(d, t, place), offset));
  }
  if (last) {  // what they have glided along for so long, they have met
    m.met = hn::Or(m.met, m.active);
    m.active = hn::MaskFromVec(hn::Zero(d));
  }
  const auto ended = hn::AndNot(m.active, valid);
  if (!hn::AllFalse(d, ended)) report(d, t, rays, m, ended, all.number + at, hits);
  const auto keep = [&](Marches::Field k, hn::Vec<D> v)
                        HWY_ATTR { hn::StoreU(hn::Compress(v, m.active), d, all.field[k] + left); };
  for (size_t k = 0; k < Marches::kOwn; ++k) keep(static_cast<Marches::Field>(k), of(static_cast<Marches::Field>(k)));
  keep(Marches::kOwn, m.own), keep(Marches::kBegin, m.begin), keep(Marches::kS, m.s), keep(Marches::kFree, m.free);
  keep(Marches::kStep, m.step), keep(Marches::kSkipped, m.skipped);
  const auto number = hn::LoadU(du, all.number + at);
  hn::StoreU(hn::Compress(number, hn::RebindMask(du, m.active)), du, all.number + left);
  return hn::CountTrue(d, m.active);
}

template <class D>
HWY_INLINE void march_ways(D d, const ShellTable& t, const ShellWay* ways, size_t count, ShellHit* hits) {
  Marches all;
  for (size_t i = 0; i < count; ++i) all.take(i, ways[i], i);
  // What fills the last vector.
  for (size_t i = count; i % hn::Lanes(d) != 0; ++i) all.take(i, ways[0], 0);
  for (int looks = 0; count > 0; looks += kLooks) {
    const bool last = looks + kLooks >= kMostShellLooks;
    size_t left = 0;
    for (size_t at = 0; at < count; at += hn::Lanes(d)) left += march_some(d, t, all, at, count, left, last, hits);
    count = left;
  }
}

void march_ways_simd(const ShellTable& table, const ShellWay* ways, size_t count, ShellHit* hits) {
  if (count <= hn::Lanes(Few())) return march_ways(Few(), table, ways, count, hits);
  march_ways(Many(), table, ways, count, hits);
}

template <class D>
HWY_INLINE void distances(D d, const ShellTable& table, const Vec3* places, size_t count, float* distance) {
  alignas(64) float x[kLongest] = {}, y[kLongest] = {}, z[kLongest] = {}, found[kLongest];
  for (size_t at = 0; at < count; at += hn::Lanes(d)) {
    const size_t some = std::min(hn::Lanes(d), count - at);
    for (size_t i = 0; i < hn::Lanes(d); ++i) {
      const Vec3& q = places[at + std::min(i, some - 1)];
      x[i] = q.x, y[i] = q.y, z[i] = q.z;
    }
    hn::Store(distance_at(d, table, {hn::Load(d, x), hn::Load(d, y), hn::Load(d, z)}), d, found);
    std::copy_n(found, some, distance + at);
  }
}

void distances_simd(const ShellTable& table, const Vec3* places, size_t count, float* distance) {
  if (count <= hn::Lanes(Few())) return distances(Few(), table, places, count, distance);
  distances(Many(), table, places, count, distance);
}

Vec3 place_on_simd(const ShellRay& ray, float sine, float s) {
  const Few d;
  const auto all = [&](float x) HWY_ATTR { return hn::Set(d, x); };
  const PlaceLanes<Few> place = place_on(d,
                                         {all(ray.place.x), all(ray.place.y), all(ray.along.x), all(ray.along.y),
                                          all(sine), all(ray.cosine), all(ray.curvature), all(ray.scale)},
                                         all(s));
  return {hn::GetLane(place.x), hn::GetLane(place.y), hn::GetLane(place.z)};
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace velour {

HWY_EXPORT(march_ways_simd);
HWY_EXPORT(distances_simd);
HWY_EXPORT(place_on_simd);

void march_shells(const ShellTable& table, std::span<const ShellWay> ways, ShellHit* hits) {
  if (!ways.empty()) VELOUR_SIMD_DISPATCH(march_ways_simd)(table, ways.data(), ways.size(), hits);
}

void shell_distances(const ShellTable& table, std::span<const Vec3> places, float* distance) {
  VELOUR_SIMD_DISPATCH(distances_simd)(table, places.data(), places.size(), distance);
}

Vec3 place_on_ray(const ShellRay& ray, float s) { return VELOUR_SIMD_DISPATCH(place_on_simd)(ray, sine_of(ray), s); }

}  // namespace velour
#endif

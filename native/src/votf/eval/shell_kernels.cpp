// Highway compiles this file once for each instruction set.
#include "votf/eval/shell_trace.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "votf/eval/shell_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "math/srbf/front_lanes-inl.h"
#include "votf/eval/shell_lanes-inl.h"
#include "votf/eval/shell_march-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Few = hn::CappedTag<float, 4>;  // for few rays, where gathers in unused lanes are wasted
using Many = hn::CappedTag<float, 16>;
constexpr size_t kLongest = 16;

/// Active rays, as a structure of arrays.
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
    kHeight,
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
                                   ray.height,
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
  return {of(Marches::kX),      of(Marches::kY),         of(Marches::kAlongX), of(Marches::kAlongY), of(Marches::kSine),
          of(Marches::kCosine), of(Marches::kCurvature), of(Marches::kScale),  of(Marches::kHeight)};
}

constexpr int kLooks = 4;  // look-ups of all rays between compactions

/// Writes the hits of those rays of a vector that have ended.
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

/// Advances the vector of rays at `at`, of `count` in all, by kLooks look-ups. Moves unfinished rays to `left` and
/// returns their number.
template <class D>
HWY_INLINE size_t march_some(D d, const ShellTable& t, Marches& all, size_t at, size_t count, size_t left, bool last,
                             ShellHit* hits) {
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
  if (last) {  // a ray that glides along a surface for so long has hit it
    m.met = hn::Or(m.met, m.active);
    m.active = hn::MaskFromVec(hn::Zero(d));
  }
  const auto ended = hn::AndNot(m.active, valid);
  if (!hn::AllFalse(d, ended)) report(d, t, rays, m, ended, all.number + at, hits);
  const FrontLanes front(d, m.active);
  const auto keep = [&](Marches::Field k, hn::Vec<D> v)
                        HWY_ATTR { hn::StoreU(front.of(d, v), d, all.field[k] + left); };
  for (size_t k = 0; k < Marches::kOwn; ++k) keep(static_cast<Marches::Field>(k), of(static_cast<Marches::Field>(k)));
  keep(Marches::kOwn, m.own), keep(Marches::kBegin, m.begin), keep(Marches::kS, m.s), keep(Marches::kFree, m.free);
  keep(Marches::kStep, m.step), keep(Marches::kSkipped, m.skipped);
  const hn::RebindToUnsigned<D> du;
  hn::StoreU(front.of(du, hn::LoadU(du, all.number + at)), du, all.number + left);
  return front.count();
}

template <class D>
HWY_INLINE void march_ways(D d, const ShellTable& t, const ShellWay* ways, size_t count, ShellHit* hits) {
  Marches all;
  for (size_t i = 0; i < count; ++i) all.take(i, ways[i], i);
  // Pads the last vector.
  for (size_t i = count; i % hn::Lanes(d) != 0; ++i) all.take(i, ways[0], 0);
  for (int looks = 0; count > 0; looks += kLooks) {
    const bool last = looks + kLooks >= kMaxShellLooks;
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
  const PlaceLanes<Few> place = place_on(d, ray_in_all(d, ray, sine), hn::Set(d, s));
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

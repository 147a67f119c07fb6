// Highway compiles this file once for each instruction set.
#include "votf/eval/shell_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "votf/eval/shell_depth.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "votf/eval/shell_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Many = hn::CappedTag<float, 16>;

ShellDepth deepest_simd(const ShellTable& t, const ShellWay& way, float from, float most) {
  const Many d;
  using V = hn::Vec<Many>;
  const RayLanes<Many> ray = ray_in_all(d, way.ray, way.sine);
  const float far = std::abs(way.end - from), towards = way.end < from ? -1.0f : 1.0f;
  const float stride = std::max(t.pitch / way.speed, far / kMaxDepthLooks);
  const V top = hn::Set(d, t.top), offset = hn::Set(d, way.offset), first = hn::Iota(d, 0);
  ShellDepth deepest{-std::numeric_limits<float>::infinity(), from};
  // An integer counter, so that the loop also ends where the stride vanishes.
  for (int look = 0; look <= kMaxDepthLooks && deepest.depth < most; look += static_cast<int>(hn::Lanes(d))) {
    const float gone = stride * static_cast<float>(look);
    if (!(gone <= far)) break;
    const V ahead = hn::Min(hn::MulAdd(first, hn::Set(d, stride), hn::Set(d, gone)), hn::Set(d, far));
    const V s = hn::MulAdd(ahead, hn::Set(d, towards), hn::Set(d, from));
    PlaceLanes<Many> place = place_on(d, ray, s);
    place.z = hn::Add(place.z, top);
    const V depth = hn::Sub(offset, distance_at(d, t, place)), most_here = hn::MaxOfLanes(d, depth);
    if (!(hn::GetLane(most_here) > deepest.depth)) continue;
    const intptr_t lane = std::max<intptr_t>(0, hn::FindFirstTrue(d, hn::Eq(depth, most_here)));
    deepest = {hn::GetLane(most_here), from + towards * std::min(far, gone + stride * static_cast<float>(lane))};
  }
  return deepest;
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace velour {

HWY_EXPORT(deepest_simd);

ShellDepth deepest_behind(const ShellField& field, const ShellWay& way, float from, float most) {
  return VELOUR_SIMD_DISPATCH(deepest_simd)(field.table(), way, from, most);
}

ShellOutline outline_beside(const ShellField& field, const ShellWay& way, float s, float most) {
  const ShellDepth deepest = deepest_behind(field, way, s, most);
  if (deepest.depth >= most) return {deepest.depth, Vec3(0.0f)};
  const Vec3 top(0, 0, field.volume().top), place = way.ray.at(deepest.s);
  const float pitch = std::copysign(field.volume().pitch() / way.speed, way.end - s);
  const Vec3 slope = field.gradient(place + top), along = glm::normalize(way.ray.at(deepest.s + pitch) - place);
  const Vec3 across = slope - glm::dot(slope, along) * along;
  const float length = glm::length(across);
  return {std::max(deepest.depth, 0.0f), length > 0 ? across / length : Vec3(0.0f)};
}

}  // namespace velour
#endif

// Highway compiles this file once for each instruction set. Multiplications and additions are not fused, so that all of
// them give the same bits.
#include "capture/btf/view_capture.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "capture/btf/light_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "math/srbf/front_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 16>;
using V = hn::Vec<Tag>;

HWY_INLINE V dot(const Vec3& a, V x, V y, V z) {
  const Tag d;
  const V xy = hn::Add(hn::Mul(hn::Set(d, a.x), x), hn::Mul(hn::Set(d, a.y), y));
  return hn::Add(xy, hn::Mul(hn::Set(d, a.z), z));
}

/// Writes whole vectors: `numbers` must have room for one vector more than there are places.
size_t facing_places_simd(const PlaceNormals& normals, const Vec3& wl, uint32_t* numbers) {
  const Tag d;
  const hn::RebindToUnsigned<Tag> du;
  size_t count = 0;
  for (size_t at = 0; at < normals.count(); at += hn::Lanes(d)) {
    const auto load = [&](size_t c) HWY_ATTR { return hn::LoadU(d, normals.component(c) + at); };
    const V geometric = dot(wl, load(0), load(1), load(2)), shading = dot(wl, load(3), load(4), load(5));
    const FrontLanes faces(d, hn::Gt(hn::Min(geometric, shading), hn::Zero(d)));
    hn::StoreU(faces.of(du, hn::Iota(du, static_cast<uint32_t>(at))), du, numbers + count);
    count += faces.count();
  }
  return count;
}

/// An array that is written in whole vectors, past its last element.
template <class T>
struct Staged {
  alignas(64) T v[DirectionBatch::kCapacity + 16];
};

void collect_lit_simd(const LightGroup& group, uint32_t first, uint64_t mask, const Frame& frame, LitLights& lit) {
  const Tag d;
  const hn::RebindToUnsigned<Tag> du;
  const auto lanes = static_cast<uint32_t>(hn::Lanes(d));
  Staged<float> x, y, z, weight;
  Staged<uint32_t> number;
  uint32_t count = 0;
  for (uint32_t at = 0; mask >> at != 0; at += lanes) {
    const uint64_t bits = mask >> at;
    const FrontLanes wanted(d, hn::LoadMaskBits(d, reinterpret_cast<const uint8_t*>(&bits)));
    const uint32_t from = first + at;
    const V wx = hn::Load(d, group.x + from), wy = hn::Load(d, group.y + from), wz = hn::Load(d, group.z + from);
    const V local_z = dot(frame.z, wx, wy, wz);
    hn::StoreU(wanted.of(d, dot(frame.x, wx, wy, wz)), d, x.v + count);
    hn::StoreU(wanted.of(d, dot(frame.y, wx, wy, wz)), d, y.v + count);
    hn::StoreU(wanted.of(d, local_z), d, z.v + count);
    hn::StoreU(wanted.of(d, hn::Mul(local_z, hn::Load(d, group.per_irradiance + from))), d, weight.v + count);
    hn::StoreU(wanted.of(du, hn::Iota(du, from)), du, number.v + count);
    count += static_cast<uint32_t>(wanted.count());
    if (at + lanes == 64) break;
  }
  std::copy_n(x.v, count, lit.wl.x);
  std::copy_n(y.v, count, lit.wl.y);
  std::copy_n(z.v, count, lit.wl.z);
  std::copy_n(weight.v, count, lit.weight);
  std::copy_n(number.v, count, lit.number);
  lit.wl.count = static_cast<int>(count);
  lit.wl.pad();
}

template <class D, class VD = hn::Vec<D>>
HWY_INLINE void add_to(D d, VD value, double* sum) {
  hn::Store(hn::Add(hn::Load(d, sum), value), d, sum);
}

uint32_t add_path_simd(const float (&path)[3][kLightsTogether], const Vec3& weights, uint32_t lights, PathSums& sums) {
  const hn::CappedTag<double, 8> dd;
  const hn::Rebind<float, decltype(dd)> d;
  const auto lanes = static_cast<uint32_t>(hn::Lanes(dd));
  uint32_t good = 0, all = 0;
  for (uint32_t l = 0; l < lights; l += lanes, all += lanes) {
    const auto r = hn::Load(d, path[0] + l), g = hn::Load(d, path[1] + l), b = hn::Load(d, path[2] + l);
    const auto rg = hn::Add(hn::Mul(hn::Set(d, weights.r), r), hn::Mul(hn::Set(d, weights.g), g));
    const auto y = hn::Add(rg, hn::Mul(hn::Set(d, weights.b), b));
    const auto finite = hn::IsFinite(y);
    good += static_cast<uint32_t>(hn::CountTrue(d, finite));
    add_to(dd, hn::PromoteTo(dd, hn::IfThenElseZero(finite, r)), sums.sum[0] + l);
    add_to(dd, hn::PromoteTo(dd, hn::IfThenElseZero(finite, g)), sums.sum[1] + l);
    add_to(dd, hn::PromoteTo(dd, hn::IfThenElseZero(finite, b)), sums.sum[2] + l);
    const auto luminance = hn::PromoteTo(dd, hn::IfThenElseZero(finite, y));
    add_to(dd, luminance, sums.luminance + l);
    add_to(dd, hn::Mul(luminance, luminance), sums.luminance_sq + l);
  }
  return all - good;
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace velour {

HWY_EXPORT(facing_places_simd);
HWY_EXPORT(collect_lit_simd);
HWY_EXPORT(add_path_simd);

namespace {

constexpr size_t kLongestVector = 16;

}  // namespace

void PlaceNormals::push(const Vec3& geometric, const Vec3& shading) {
  if (components_[0].size() < count_ + kLongestVector) {
    for (std::vector<float>& c : components_) c.resize(2 * count_ + kLongestVector);
  }
  for (int c = 0; c < 3; ++c) {
    components_[static_cast<size_t>(c)][count_] = geometric[c];
    components_[static_cast<size_t>(c) + 3][count_] = shading[c];
  }
  ++count_;
}

void facing_places(const PlaceNormals& normals, const Vec3& wl, std::vector<uint32_t>& numbers) {
  numbers.resize(normals.count() + 2 * kLongestVector);
  size_t count = VELOUR_SIMD_DISPATCH(facing_places_simd)(normals, wl, numbers.data());
  while (count > 0 && numbers[count - 1] >= normals.count()) --count;  // padding of the last vector
  numbers.resize(count);
}

void collect_lit(const LightGroup& group, uint32_t first, uint64_t mask, const Frame& frame, LitLights& lit) {
  VELOUR_SIMD_DISPATCH(collect_lit_simd)(group, first, mask, frame, lit);
}

uint32_t add_path(const float (&path)[3][kLightsTogether], const Vec3& luminance_weights, uint32_t lights,
                  PathSums& sums) {
  return VELOUR_SIMD_DISPATCH(add_path_simd)(path, luminance_weights, lights, sums);
}

}  // namespace velour
#endif

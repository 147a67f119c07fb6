// SIMD lanes that formulas use like scalars (math/sphere/number_math.h has the scalar operations). Included once per
// instruction set by sources that use foreach_target.h. Multiplications and additions are never fused, so every
// instruction set gives the same bits as the scalar formula.
#if defined(VELOUR_SRBF_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VELOUR_SRBF_LANES_INL_H_
#undef VELOUR_SRBF_LANES_INL_H_
#else
#define VELOUR_SRBF_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "math/sphere/directions.h"
#include "math/sphere/number_math.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using velour::larger;
using velour::select;
using velour::smaller;
using velour::square_root;

#if HWY_HAVE_SCALABLE
// Scalable vectors cannot be members, so these targets process one number at a time.
using Lanes = float;
inline constexpr int kLanes = 1;
HWY_INLINE Lanes load_lanes(const float* from) { return *from; }
HWY_INLINE void store_lanes(Lanes lanes, float* to) { *to = lanes; }
#else
using LanesTag = hn::CappedTag<float, 16>;
inline constexpr int kLanes = static_cast<int>(hn::MaxLanes(LanesTag()));

struct Lanes {
  hn::Vec<LanesTag> v;

  HWY_INLINE Lanes(float x) : v(hn::Set(LanesTag(), x)) {}
  HWY_INLINE explicit Lanes(hn::Vec<LanesTag> lanes) : v(lanes) {}
};
struct LanesMask {
  hn::Mask<LanesTag> v;
};

HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return Lanes(hn::Add(a.v, b.v)); }
HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return Lanes(hn::Sub(a.v, b.v)); }
HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return Lanes(hn::Mul(a.v, b.v)); }
HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return Lanes(hn::Div(a.v, b.v)); }
HWY_INLINE LanesMask operator>(Lanes a, Lanes b) { return {hn::Gt(a.v, b.v)}; }
HWY_INLINE Lanes square_root(Lanes x) { return Lanes(hn::Sqrt(x.v)); }
HWY_INLINE Lanes larger(Lanes a, Lanes b) { return Lanes(hn::Max(a.v, b.v)); }
HWY_INLINE Lanes smaller(Lanes a, Lanes b) { return Lanes(hn::Min(a.v, b.v)); }
HWY_INLINE Lanes select(LanesMask condition, Lanes yes, Lanes no) {
  return Lanes(hn::IfThenElse(condition.v, yes.v, no.v));
}
HWY_INLINE Lanes load_lanes(const float* from) { return Lanes(hn::Load(LanesTag(), from)); }
HWY_INLINE void store_lanes(Lanes lanes, float* to) { hn::Store(lanes.v, LanesTag(), to); }
#endif

/// One direction per lane.
struct LanesVec3 {
  Lanes x, y, z;
};
HWY_INLINE Lanes dot(const Vec3& a, const LanesVec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Directions [at, at + kLanes) of a padded batch.
HWY_INLINE LanesVec3 load_directions(const DirectionBatch& batch, int at) {
  return {load_lanes(batch.x + at), load_lanes(batch.y + at), load_lanes(batch.z + at)};
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#endif

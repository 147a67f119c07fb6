// Moves selected lanes of vectors to the front. Included once per instruction set by sources that use foreach_target.h.
#if defined(VELOUR_SRBF_FRONT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VELOUR_SRBF_FRONT_LANES_INL_H_
#undef VELOUR_SRBF_FRONT_LANES_INL_H_
#else
#define VELOUR_SRBF_FRONT_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "math/srbf/front_lanes.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Moves the lanes of a mask to the front, in order; the lanes behind them are unspecified. Replaces Compress: on x86
/// before AVX-512 Highway implements it with a table that GCC copies to the stack for each vector, which takes longer
/// than most kernels.
template <class D>
class FrontLanes {
 public:
  HWY_INLINE FrontLanes(D d, hn::Mask<D> mask) : count_(hn::CountTrue(d, mask)), mask_(mask) {
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SSSE3
    const hn::RebindToSigned<D> di;
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    lanes_ = hn::PromoteTo(di, hn::LoadU(hn::Rebind<uint8_t, D>(), kFrontLanes.lane[bits[0]]));
#endif
  }

  size_t count() const { return count_; }

  /// Lanes of D2 have the same size as those of D.
  template <class D2>
  HWY_INLINE hn::Vec<D2> of(D2 d, hn::Vec<D2> v) const {
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SSSE3
    return hn::TableLookupLanes(v, hn::IndicesFromVec(d, lanes_));
#else
    return hn::Compress(v, hn::RebindMask(d, mask_));
#endif
  }

 private:
  size_t count_;
  hn::Mask<D> mask_;
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_SSE4 || HWY_TARGET == HWY_SSSE3
  hn::Vec<hn::RebindToSigned<D>> lanes_;
#endif
};

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#endif

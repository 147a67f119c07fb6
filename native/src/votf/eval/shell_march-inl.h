// Vectorized sphere tracing. Included once for each instruction set, by sources that Highway compiles for several.
#if defined(VELOUR_VOTF_SHELL_MARCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VELOUR_VOTF_SHELL_MARCH_INL_H_
#undef VELOUR_VOTF_SHELL_MARCH_INL_H_
#else
#define VELOUR_VOTF_SHELL_MARCH_INL_H_
#endif

#include <hwy/highway.h>

#include "votf/eval/shell_trace.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// State of the rays between look-ups.
template <class D>
struct March {
  using V = hn::Vec<D>;
  using Lanes = hn::Mask<D>;
  V way, per_speed, end, own;       // way: 1 forward, -1 backward; per_speed: meters per tile width, signed by way
  V begin, s, free, step, skipped;  // the last look-up was `step` widths before, with `free` widths to any surface
  Lanes active, met;

  /// Advances the rays from points at `distance` from the structure.
  HWY_INLINE void look(D d, const ShellTable& t, V distance) {
    const V least = hn::Set(d, kMinShellStep * t.pitch);
    Lanes within = hn::And(active, hn::Le(distance, hn::Set(d, kWithinShell * t.pitch)));
    Lanes goes = hn::AndNot(within, active);
    const Lanes on_own = hn::And(active, hn::Gt(own, hn::Zero(d)));
    if (!hn::AllFalse(d, on_own)) within = hn::AndNot(leave_own(d, within, on_own, distance, least), within);
    if (!hn::AllFalse(d, within)) meet(d, within, distance);
    go_on(d, goes, distance, least);
  }

 private:
  /// Moves rays out of the structure that they start on. Returns those that were still inside it.
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

  /// Puts the hit where the distance, interpolated between the two look-ups, is zero.
  HWY_INLINE void meet(D d, Lanes meets, V distance) {
    const V part = hn::Min(hn::Set(d, 1.0f), hn::Div(distance, hn::Sub(distance, free)));
    const V at = hn::NegMulAdd(hn::Mul(per_speed, step), part, s);
    s = hn::IfThenElse(hn::AndNot(hn::Eq(step, hn::Zero(d)), meets), at, s);
    met = hn::Or(met, meets);
    active = hn::AndNot(meets, active);
  }

  HWY_INLINE void go_on(D d, Lanes goes, V distance, V least) {
    const V zero = hn::Zero(d);
    // There may be a surface between the two look-ups: back to the end of the known free space.
    const Lanes doubts = hn::And(goes, hn::Lt(hn::Add(free, distance), step)), trusts = hn::AndNot(doubts, goes);
    const V back = hn::NegMulAdd(per_speed, hn::Sub(step, free), s);
    V next_step = hn::Mul(hn::Set(d, kShellStride), hn::Max(distance, least));
    V next = hn::MulAdd(per_speed, next_step, s);
    const Lanes ends = hn::And(trusts, hn::Ge(hn::Mul(hn::Sub(next, end), way), zero));
    if (!hn::AllFalse(d, ends)) {
      // The last look-up is at the end, unless the way to it is known to be free.
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

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#endif

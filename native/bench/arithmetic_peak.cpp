// Highway compiles this file once for each instruction set.
#include "bench/arithmetic_peak.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/arithmetic_peak.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/process.h"
#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One lobe's operations, on one register.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V one_lobe(D d, V x, V a, V b) {
  const hn::RebindToSigned<D> di;
  for (int i = 0; i < 3; ++i) x = hn::Mul(hn::Sub(hn::Add(x, a), b), a);
  x = hn::BitCast(d, hn::ShiftLeft<1>(hn::BitCast(di, hn::Max(x, a))));
  for (int i = 0; i < 11; ++i) x = hn::MulAdd(x, a, b);
  return x;
}

/// `rounds` times one lobe in each of ten registers; returns how many lobes times directions that were.
double run_simd(int rounds, float* result) {
  const hn::CappedTag<float, 16> d;
  const auto a = hn::Set(d, 0.5f), b = hn::Set(d, 0.25f);
  auto x0 = hn::Iota(d, 0), x1 = hn::Iota(d, 1), x2 = hn::Iota(d, 2), x3 = hn::Iota(d, 3), x4 = hn::Iota(d, 4);
  auto x5 = hn::Iota(d, 5), x6 = hn::Iota(d, 6), x7 = hn::Iota(d, 7), x8 = hn::Iota(d, 8), x9 = hn::Iota(d, 9);
  for (int i = 0; i < rounds; ++i) {
    x0 = one_lobe(d, x0, a, b);
    x1 = one_lobe(d, x1, a, b);
    x2 = one_lobe(d, x2, a, b);
    x3 = one_lobe(d, x3, a, b);
    x4 = one_lobe(d, x4, a, b);
    x5 = one_lobe(d, x5, a, b);
    x6 = one_lobe(d, x6, a, b);
    x7 = one_lobe(d, x7, a, b);
    x8 = one_lobe(d, x8, a, b);
    x9 = one_lobe(d, x9, a, b);
  }
  const auto low = hn::Add(hn::Add(x0, x1), hn::Add(hn::Add(x2, x3), x4));
  const auto high = hn::Add(hn::Add(x5, x6), hn::Add(hn::Add(x7, x8), x9));
  *result = hn::GetLane(hn::Add(low, high));
  return 10.0 * rounds * static_cast<double>(hn::Lanes(d));
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {
namespace {

HWY_EXPORT(run_simd);

double measure() {
  double best = 1;
  for (int run = 0; run < 200; ++run) {
    volatile float keep;
    float result;
    const double start = thread_seconds();
    const double done = VELOUR_SIMD_DISPATCH(run_simd)(2000, &result);
    best = std::min(best, (thread_seconds() - start) / done);
    keep = result;
    static_cast<void>(keep);
  }
  return best;
}

}  // namespace

double arithmetic_peak_seconds() {
  static const double seconds = measure();
  return seconds;
}

}  // namespace velour
#endif

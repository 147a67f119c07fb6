// Highway compiles this file once for each instruction set.
#include "brdf/eval/parametric_table.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/eval/parametric_values.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/simd_dispatch.h"
#include "math/sphere/simd_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Parameter `which` of the lobes from index `at` on.
template <int kTaps, class D, class V = hn::Vec<D>>
HWY_INLINE V parameter(D d, const SplineRows& rows, const float* weight, int which, int at) {
  const float* from = rows.control + which * rows.stride + at;
  V sum = hn::Zero(d);
  for (int i = 0; i < kTaps; ++i) {
    sum = hn::MulAdd(hn::Set(d, weight[i]), hn::LoadU(d, from + rows.taps.node[i] * rows.row), sum);
  }
  return sum;
}

/// sin(x) / x or sinh(x) / x for x >= 0, from `sine` and x.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V over(D d, V sine, V x) {
  const auto tiny = hn::Lt(x, hn::Set(d, 1e-6f));
  return hn::IfThenElse(tiny, hn::Set(d, 1.0f), hn::Div(sine, x));
}

/// tilted_normal() and stretch_from() in the plane of incidence.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_shape_on_meridian(D d, V tilt, V stretch, int at, WarpedMixture& m) {
  V sine, cosine;
  sin_cos_within_pi(d, tilt, sine, cosine);
  hn::Store(sine, d, m.x + at);
  hn::Store(hn::Zero(d), d, m.y + at);
  hn::Store(cosine, d, m.z + at);
  const V grown = exp2_clamped(d, hn::Mul(hn::Set(d, kLog2E), stretch));
  hn::Store(hn::Div(hn::Set(d, 1.0f), grown), d, m.s_xx + at);
  hn::Store(hn::Zero(d), d, m.s_xy + at);
  hn::Store(grown, d, m.s_yy + at);
}

/// tilted_normal() and stretch_from() in general.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_shape(D d, V tilt_x, V tilt_y, V a, V b, int at, WarpedMixture& m) {
  const V angle = hn::Sqrt(hn::MulAdd(tilt_x, tilt_x, hn::Mul(tilt_y, tilt_y)));
  V sine, cosine;
  sin_cos_within_pi(d, angle, sine, cosine);
  const V s = over(d, sine, angle);
  hn::Store(hn::Mul(s, tilt_x), d, m.x + at);
  hn::Store(hn::Mul(s, tilt_y), d, m.y + at);
  hn::Store(cosine, d, m.z + at);
  const V size = hn::Sqrt(hn::MulAdd(a, a, hn::Mul(b, b))), half = hn::Set(d, 0.5f);
  const V grown = exp2_clamped(d, hn::Mul(hn::Set(d, kLog2E), size)), shrunk = hn::Div(hn::Set(d, 1.0f), grown);
  const V middle = hn::Mul(half, hn::Add(grown, shrunk));
  const V ratio = over(d, hn::Mul(half, hn::Sub(grown, shrunk)), size);
  hn::Store(hn::NegMulAdd(ratio, a, middle), d, m.s_xx + at);
  hn::Store(hn::Mul(ratio, b), d, m.s_xy + at);
  hn::Store(hn::MulAdd(ratio, a, middle), d, m.s_yy + at);
}

template <bool kIsotropic>
HWY_INLINE void evaluate_lobes(const SplineRows& rows, WarpedMixture& m) {
  using P = ParametricBrdf;
  constexpr int kTaps = kIsotropic ? SplineRows::kIsotropicTaps : ViewTaps::kMost;
  const hn::CappedTag<float, 8> d;  // padded is a multiple of it
  for (int at = 0; at < m.padded; at += static_cast<int>(hn::Lanes(d))) {
    hn::Store(hn::LoadU(d, rows.half + at), d, m.half + at);
    const auto of = [&](int which) { return parameter<kTaps>(d, rows, rows.taps.weight, which, at); };
    const auto exp_of = [&](int which) { return exp2_clamped(d, of(which)); };  // stored as logarithms to base 2
    hn::Store(exp_of(P::kLogBandwidth), d, m.bandwidth + at);
    hn::Store(exp_of(P::kLogRed), d, m.r + at);
    hn::Store(exp_of(P::kLogGreen), d, m.g + at);
    hn::Store(exp_of(P::kLogBlue), d, m.b + at);
    if constexpr (kIsotropic) {
      const auto tilt = parameter<kTaps>(d, rows, rows.taps.odd_weight, P::kTiltX, at);
      store_shape_on_meridian(d, tilt, hn::Mul(hn::Set(d, rows.stretch), of(P::kStretchA)), at, m);
    } else {
      store_shape(d, of(P::kTiltX), of(P::kTiltY), of(P::kStretchA), of(P::kStretchB), at, m);
    }
  }
}

void evaluate_simd(const SplineRows& rows, bool isotropic, WarpedMixture& m) {
  return isotropic ? evaluate_lobes<true>(rows, m) : evaluate_lobes<false>(rows, m);
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/error.h"

namespace velour {

HWY_EXPORT(evaluate_simd);

namespace {

/// Log coefficient of padding lobes; its exponential is 0.
constexpr float kNoCoefficient = -1000;

float stored(int parameter, float value) {
  const bool is_logarithm = parameter >= ParametricBrdf::kLogBandwidth && parameter <= ParametricBrdf::kLogBlue;
  return is_logarithm ? value * kLog2E : value;
}

float neutral(int parameter) {
  const bool is_coefficient = parameter >= ParametricBrdf::kLogRed && parameter <= ParametricBrdf::kLogBlue;
  return is_coefficient ? kNoCoefficient : 0.0f;
}

}  // namespace

ParametricValues::ParametricValues(const ParametricBrdf& brdf)
    : spline_(brdf.spline()), count_(brdf.lobe_count()), padded_(WarpedMixture::padded_of(count_)) {
  if (count_ > WarpedMixture::kCapacity) {
    throw Error(Status::invalid_argument, "The parametric model has " + std::to_string(count_) + " lobes; at most " +
                                              std::to_string(WarpedMixture::kCapacity) +
                                              " are supported. Fit it again with fewer lobes.");
  }
  for (int j = 0; j < padded_; ++j) {
    half_.push_back(j < count_ && brdf.space[static_cast<size_t>(j)] == LobeSpace::half ? 1.0f : 0.0f);
  }
  for (int node = 0; node < spline_.node_count(); ++node) {
    for (int k = 0; k < brdf.parameter_count(); ++k) {
      for (int j = 0; j < padded_; ++j) {
        control_.push_back(j < count_ ? stored(k, brdf.control[brdf.index(node, k, j)]) : neutral(k));
      }
    }
  }
}

void ParametricValues::evaluate(const Vec3& wv, const ViewPlace& place, WarpedMixture& mixture) const {
  SplineRows rows{half_.data(),
                  control_.data(),
                  padded_,
                  padded_ * ParametricBrdf::parameters_of(isotropic()),
                  1,
                  spline_.at(PolarView<float>{place.theta, place.cos_phi, place.sin_phi})};
  // Beyond 11 degrees the fade is 1 in float.
  if (place.theta < 0.2f) rows.stretch = static_cast<float>(pole_fade(static_cast<double>(place.theta)));
  while (rows.taps.count < SplineRows::kIsotropicTaps) rows.taps.add(0, 0, 0);  // fewer taps next to the normal
  mixture.count = count_;
  mixture.padded = padded_;
  mixture.list_all();
  mixture.turn_cos = isotropic() ? place.cos_phi : 1.0f;
  mixture.turn_sin = isotropic() ? place.sin_phi : 0.0f;
  mixture.wv = isotropic() ? Vec3(place.sine, 0, wv.z) : wv;
  VELOUR_SIMD_DISPATCH(evaluate_simd)(rows, isotropic(), mixture);
}

}  // namespace velour
#endif

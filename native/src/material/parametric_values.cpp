// Highway compiles this file once for each instruction set.
#include "material/parametric_values.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "material/parametric_values.cpp"
#include <hwy/foreach_target.h>

// Only after that one:
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "material/spline_rows.h"
#include "srbf/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace velour {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Parameters of the lobes from `at` on.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V parameter(D d, const SplineRows& rows, const float* weight, int which, int at) {
  V sum = hn::Zero(d);
  for (int i = 0; i < rows.count; ++i) {
    sum = hn::MulAdd(hn::Set(d, weight[i]), hn::LoadU(d, rows.row[i] + which * rows.stride + at), sum);
  }
  return sum;
}

/// sin(x) / x of x >= 0, and of sinh.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V over(D d, V sine, V x) {
  const auto tiny = hn::Lt(x, hn::Set(d, 1e-6f));
  return hn::IfThenElse(tiny, hn::Set(d, 1.0f), hn::Div(sine, x));
}

/// tilted_normal and stretch_from in the plane of incidence.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_shape_on_meridian(D d, V tilt, V stretch, int at, WarpedMixture& m) {
  hn::Store(hn::Sin(d, tilt), d, m.x + at);
  hn::Store(hn::Zero(d), d, m.y + at);
  hn::Store(hn::Cos(d, tilt), d, m.z + at);
  const V grown = hn::Exp(d, stretch);
  hn::Store(hn::Div(hn::Set(d, 1.0f), grown), d, m.s_xx + at);
  hn::Store(hn::Zero(d), d, m.s_xy + at);
  hn::Store(grown, d, m.s_yy + at);
}

/// The same anywhere.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void store_shape(D d, V tilt_x, V tilt_y, V a, V b, int at, WarpedMixture& m) {
  const V angle = hn::Sqrt(hn::MulAdd(tilt_x, tilt_x, hn::Mul(tilt_y, tilt_y)));
  const V s = over(d, hn::Sin(d, angle), angle);
  hn::Store(hn::Mul(s, tilt_x), d, m.x + at);
  hn::Store(hn::Mul(s, tilt_y), d, m.y + at);
  hn::Store(hn::Cos(d, angle), d, m.z + at);
  const V size = hn::Sqrt(hn::MulAdd(a, a, hn::Mul(b, b))), half = hn::Set(d, 0.5f);
  const V grown = hn::Exp(d, size), shrunk = hn::Div(hn::Set(d, 1.0f), grown);
  const V cosine = hn::Mul(half, hn::Add(grown, shrunk));
  const V ratio = over(d, hn::Mul(half, hn::Sub(grown, shrunk)), size);
  hn::Store(hn::NegMulAdd(ratio, a, cosine), d, m.s_xx + at);
  hn::Store(hn::Mul(ratio, b), d, m.s_xy + at);
  hn::Store(hn::MulAdd(ratio, a, cosine), d, m.s_yy + at);
}

void evaluate_simd(const SplineRows& rows, bool isotropic, WarpedMixture& m) {
  using P = ParametricBrdf;
  const hn::CappedTag<float, WarpedMixture::kLanes> d;
  for (int at = 0; at < m.padded; at += static_cast<int>(hn::Lanes(d))) {
    const auto of = [&](int which) { return parameter(d, rows, rows.weight, which, at); };
    const auto tilt_x = parameter(d, rows, rows.odd_weight, P::kTiltX, at);
    hn::Store(hn::Exp(d, of(P::kLogBandwidth)), d, m.bandwidth + at);
    hn::Store(hn::Exp(d, of(P::kLogRed)), d, m.r + at);
    hn::Store(hn::Exp(d, of(P::kLogGreen)), d, m.g + at);
    hn::Store(hn::Exp(d, of(P::kLogBlue)), d, m.b + at);
    if (isotropic) {
      store_shape_on_meridian(d, tilt_x, hn::Mul(hn::Set(d, rows.stretch), of(P::kStretchA)), at, m);
    } else {
      store_shape(d, tilt_x, of(P::kTiltY), of(P::kStretchA), of(P::kStretchB), at, m);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace velour
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <algorithm>

#include "brdf/fast_atan2.h"
#include "job/error.h"

namespace velour {

HWY_EXPORT(evaluate_simd);

namespace {

/// Of what fills up the lanes: exp gives 0.
constexpr float kNoCoefficient = -1000;

/// At least one vector, so that a model without lobes needs no branch.
int padded_of(int count) {
  constexpr int kLanes = WarpedMixture::kLanes;
  return std::max(1, (count + kLanes - 1) / kLanes) * kLanes;
}

bool is_logarithm_of_coefficient(int parameter) {
  return parameter >= ParametricBrdf::kLogRed && parameter <= ParametricBrdf::kLogBlue;
}

}  // namespace

ParametricValues::ParametricValues(const ParametricBrdf& brdf)
    : spline_(brdf.spline()), count_(brdf.lobe_count()), padded_(padded_of(count_)) {
  if (count_ > WarpedMixture::kCapacity) {
    throw Error(Status::invalid_argument, "the parametric model has " + std::to_string(count_) +
                                              " lobes; fit it with at most " +
                                              std::to_string(WarpedMixture::kCapacity));
  }
  for (int j = 0; j < padded_; ++j) {
    half_.push_back(j < count_ && brdf.space[static_cast<size_t>(j)] == LobeSpace::half ? 1.0f : 0.0f);
  }
  for (int node = 0; node < spline_.node_count(); ++node) {
    for (int k = 0; k < brdf.parameter_count(); ++k) {
      for (int j = 0; j < padded_; ++j) {
        const float unused = is_logarithm_of_coefficient(k) ? kNoCoefficient : 0.0f;
        control_.push_back(j < count_ ? brdf.control[brdf.index(node, k, j)] : unused);
      }
    }
  }
}

void ParametricValues::evaluate(const Vec3& wv, WarpedMixture& mixture) const {
  const float sine = std::sqrt(wv.x * wv.x + wv.y * wv.y);
  const float theta = fast_atan2(sine, wv.z), c = sine > 0 ? wv.x / sine : 1, s = sine > 0 ? wv.y / sine : 0;
  const ViewTaps taps = spline_.at(PolarView{theta, c, s});

  SplineRows rows;
  rows.count = taps.count;
  rows.stride = padded_;
  // Beyond 11 degrees the fade is 1 in float.
  rows.stretch = theta < 0.2f ? static_cast<float>(pole_fade(theta)) : 1.0f;
  const int row = padded_ * ParametricBrdf::parameters_of(isotropic());
  for (int i = 0; i < taps.count; ++i) {
    rows.row[i] = control_.data() + taps.node[i] * row;
    rows.weight[i] = static_cast<float>(taps.weight[i]);
    rows.odd_weight[i] = static_cast<float>(taps.odd_weight[i]);
  }

  mixture.count = count_;
  mixture.padded = padded_;
  mixture.turn_cos = isotropic() ? c : 1.0f;
  mixture.turn_sin = isotropic() ? s : 0.0f;
  mixture.wv = isotropic() ? Vec3(sine, 0, wv.z) : wv;
  std::copy(half_.begin(), half_.end(), mixture.half);
  VELOUR_SIMD_DISPATCH(evaluate_simd)(rows, isotropic(), mixture);
}

}  // namespace velour
#endif

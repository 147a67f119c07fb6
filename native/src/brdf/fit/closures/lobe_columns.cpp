#include "brdf/fit/closures/closures.h"

#include <algorithm>
#include <cmath>

#include "math/sphere/directions.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "brdf/fit/closures/lobe_columns.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// Require Highway's namespace of the target.
#include "base/simd_dispatch.h"
#include "math/sphere/simd_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace velour::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using LobeTag = hn::CappedTag<float, ClosureLights::kPadding>;
using LobeLanes = hn::Vec<LobeTag>;

LobeLanes lanes_of(float value) { return hn::Set(LobeTag(), value); }

// Microfacets with Smith's masking: GGX and Beckmann.

/// Smith's Lambda at t = (alpha tan(theta))^2 [H14 Eq. 72], and its derivative by t.
struct SmithLambda {
  LobeLanes value, slope;
};

template <LobeDistribution distribution, LobeMasking masking>
SmithLambda smith_lambda(LobeLanes t) {
  const LobeLanes one = lanes_of(1);
  if constexpr (distribution == LobeDistribution::ggx) {
    const LobeLanes root = hn::Sqrt(hn::Add(one, t));
    return {hn::Mul(lanes_of(0.5f), hn::Sub(root, one)), hn::Div(lanes_of(0.25f), root)};
  } else {
    // Rational approximation [WMLT07]. Versions of Cycles round its threshold, a = 1.6, differently.
    constexpr float kThreshold = masking == LobeMasking::separable ? 0.625f * 0.625f : 0.39f;
    const LobeLanes safe = hn::Max(t, lanes_of(0.5f * kThreshold)), a = hn::Div(one, hn::Sqrt(safe));
    const LobeLanes above = hn::MulAdd(hn::MulAdd(lanes_of(0.396f), a, lanes_of(-1.259f)), a, one);
    const LobeLanes below = hn::Mul(hn::MulAdd(lanes_of(2.181f), a, lanes_of(3.535f)), a);
    const LobeLanes per_below = hn::Div(one, below), value = hn::Mul(above, per_below);
    const LobeLanes above_by_a = hn::MulAdd(lanes_of(0.792f), a, lanes_of(-1.259f));
    const LobeLanes below_by_a = hn::MulAdd(lanes_of(4.362f), a, lanes_of(3.535f));
    const LobeLanes by_a = hn::Mul(hn::NegMulAdd(value, below_by_a, above_by_a), per_below);
    const LobeLanes a_by_t = hn::Mul(hn::Mul(lanes_of(-0.5f), a), hn::Mul(a, a));
    const auto rough = hn::Ge(t, lanes_of(kThreshold));
    return {hn::IfThenElseZero(rough, value), hn::IfThenElseZero(rough, hn::Mul(by_a, a_by_t))};
  }
}

/// What does not depend on the light.
struct LobeAtView {
  LobeLanes sin_tilt, cos_tilt, x_sq, y_sq, per_x_sq, per_y_sq, scale, lambda;
  LobeLanes lambda_by_x, lambda_by_y, lambda_by_tilt;  // derivatives by log(alpha_x), log(alpha_y) and tilt
  LobeLanes log_by_tilt;                               // that of log(wv.N')
};

template <LobeDistribution distribution, LobeMasking masking>
LobeAtView lobe_at_view(const ClosureLobeShape& s, const ClosureLights& lights) {
  const float x_sq = s.alpha_x * s.alpha_x, y_sq = s.alpha_y * s.alpha_y;
  const float across = std::sin(lights.theta_v()), along_z = std::cos(lights.theta_v());
  const float along_x = across * std::cos(lights.phi_v()), along_y = across * std::sin(lights.phi_v());
  const float view_z = std::max(along_x * std::sin(s.tilt) + along_z * std::cos(s.tilt), 1e-6f);
  const float tx = (along_x * std::cos(s.tilt) - along_z * std::sin(s.tilt)) / view_z, ty = along_y / view_z;
  const float t_x = x_sq * tx * tx, t_y = y_sq * ty * ty, t = t_x + t_y;
  const SmithLambda lambda = smith_lambda<distribution, masking>(lanes_of(t));
  return {lanes_of(std::sin(s.tilt)),
          lanes_of(std::cos(s.tilt)),
          lanes_of(x_sq),
          lanes_of(y_sq),
          lanes_of(1 / x_sq),
          lanes_of(1 / y_sq),
          lanes_of(1 / (4 * kPi * s.alpha_x * s.alpha_y * view_z)),
          lambda.value,
          hn::Mul(lambda.slope, lanes_of(2 * t_x)),
          hn::Mul(lambda.slope, lanes_of(2 * t_y)),
          hn::Mul(lambda.slope, lanes_of(-2 * tx * (x_sq + t))),
          lanes_of(tx)};
}

/// Value of a lobe at a vector of lights, and derivatives of its logarithm by log(alpha_x), log(alpha_y) and the tilt.
struct LobeSample {
  LobeLanes value, by_x, by_y, by_tilt;
};

template <LobeDistribution distribution, LobeMasking masking, bool slopes>
LobeSample lobe_sample(const LobeAtView& lobe, const ClosureLights& lights, size_t i) {
  const LobeTag tag;
  const LobeLanes one = lanes_of(1), two = lanes_of(2), least = lanes_of(1e-6f);
  const LobeLanes wl_x = hn::Load(tag, lights.wl_x() + i), wl_y = hn::Load(tag, lights.wl_y() + i),
                  wl_z = hn::Load(tag, lights.wl_z() + i), h_x = hn::Load(tag, lights.h_x() + i),
                  h_y = hn::Load(tag, lights.h_y() + i), h_z = hn::Load(tag, lights.h_z() + i);
  const LobeLanes light_x = hn::NegMulAdd(wl_z, lobe.sin_tilt, hn::Mul(wl_x, lobe.cos_tilt));
  const LobeLanes light_z = hn::MulAdd(wl_x, lobe.sin_tilt, hn::Mul(wl_z, lobe.cos_tilt));
  const LobeLanes half_x = hn::NegMulAdd(h_z, lobe.sin_tilt, hn::Mul(h_x, lobe.cos_tilt));
  const LobeLanes half_z = hn::MulAdd(h_x, lobe.sin_tilt, hn::Mul(h_z, lobe.cos_tilt));
  const auto lit = hn::And(hn::Gt(light_z, least), hn::Gt(half_z, least));
  const LobeLanes c = hn::Max(half_z, least), c_sq = hn::Mul(c, c);
  const LobeLanes ex = hn::Mul(hn::Mul(half_x, half_x), lobe.per_x_sq), ey = hn::Mul(hn::Mul(h_y, h_y), lobe.per_y_sq);

  LobeSample s{};
  if constexpr (distribution == LobeDistribution::ggx) {
    const LobeLanes per_q = hn::Div(one, hn::Add(hn::Add(ex, ey), c_sq)), four = hn::Mul(lanes_of(4), per_q);
    s.value = hn::Mul(per_q, per_q);
    if constexpr (slopes) {
      s.by_x = hn::MulSub(four, ex, one);
      s.by_y = hn::MulSub(four, ey, one);
      s.by_tilt = hn::Mul(hn::Mul(four, hn::Mul(half_x, c)), hn::Sub(lobe.per_x_sq, one));
    }
  } else {
    const LobeLanes per_c = hn::Div(one, c), per_c_sq = hn::Mul(per_c, per_c);
    const LobeLanes x = hn::Mul(ex, per_c_sq), y = hn::Mul(ey, per_c_sq);
    s.value = hn::Mul(exp_nonpositive(tag, hn::Neg(hn::Add(x, y))), hn::Mul(per_c_sq, per_c_sq));
    if constexpr (slopes) {
      s.by_x = hn::MulSub(two, x, one);
      s.by_y = hn::MulSub(two, y, one);
      const LobeLanes turn = hn::Sub(hn::Add(lobe.per_x_sq, hn::Add(x, y)), two);
      s.by_tilt = hn::Mul(hn::Mul(two, hn::Mul(half_x, per_c)), turn);
    }
  }

  const LobeLanes per_light = hn::Div(one, hn::Max(light_z, least));
  const LobeLanes tx = hn::Mul(light_x, per_light), ty = hn::Mul(wl_y, per_light);
  const LobeLanes t_x = hn::Mul(lobe.x_sq, hn::Mul(tx, tx)), t_y = hn::Mul(lobe.y_sq, hn::Mul(ty, ty));
  const SmithLambda of_light = smith_lambda<distribution, masking>(hn::Add(t_x, t_y));
  LobeLanes by_view, by_light;  // factors of the logarithmic derivatives
  if constexpr (masking == LobeMasking::separable) {
    const LobeLanes view = hn::Add(one, lobe.lambda), light = hn::Add(one, of_light.value);
    const LobeLanes per_both = hn::Div(one, hn::Mul(view, light));
    s.value = hn::Mul(s.value, per_both);
    by_view = hn::Mul(per_both, light), by_light = hn::Mul(per_both, view);
  } else {
    by_view = by_light = hn::Div(one, hn::Add(one, hn::Add(lobe.lambda, of_light.value)));
    s.value = hn::Mul(s.value, by_view);
  }
  const LobeLanes scale = hn::Mul(lobe.scale, hn::Load(tag, lights.root_weight() + i));
  s.value = hn::IfThenElseZero(lit, hn::Mul(s.value, scale));
  if constexpr (slopes) {
    const LobeLanes light_slope = hn::Mul(by_light, hn::Mul(two, of_light.slope));
    s.by_x = hn::NegMulAdd(by_view, lobe.lambda_by_x, hn::NegMulAdd(light_slope, t_x, s.by_x));
    s.by_y = hn::NegMulAdd(by_view, lobe.lambda_by_y, hn::NegMulAdd(light_slope, t_y, s.by_y));
    const LobeLanes turn = hn::MulAdd(tx, hn::Add(lobe.x_sq, hn::Add(t_x, t_y)), hn::Zero(tag));
    s.by_tilt = hn::MulAdd(light_slope, turn, hn::NegMulAdd(by_view, lobe.lambda_by_tilt, s.by_tilt));
    s.by_tilt = hn::Sub(s.by_tilt, lobe.log_by_tilt);
  }
  return s;
}

template <LobeDistribution distribution, LobeMasking masking>
class MicrofacetLobe {
 public:
  MicrofacetLobe(const ClosureLobeShape& shape, const ClosureLights& lights)
      : at_view_(lobe_at_view<distribution, masking>(shape, lights)) {}

  template <bool slopes>
  LobeSample at(const ClosureLights& lights, size_t i) const {
    return lobe_sample<distribution, masking, slopes>(at_view_, lights, i);
  }

 private:
  LobeAtView at_view_;
};

/// A lobe of [AS00], as Cycles has it: n = 2 / alpha^2 - 2 along each axis.
class AshikhminShirleyLobe {
 public:
  AshikhminShirleyLobe(const ClosureLobeShape& shape, const ClosureLights& lights)
      : wv_(direction(lights.theta_v(), lights.phi_v())),
        n_x_(2 / (shape.alpha_x * shape.alpha_x) - 2),
        n_y_(2 / (shape.alpha_y * shape.alpha_y) - 2) {}

  template <bool slopes>
  LobeSample at(const ClosureLights& lights, size_t i) const {
    const LobeTag tag;
    const LobeLanes one = lanes_of(1), least = lanes_of(1e-6f);
    const LobeLanes wl_z = hn::Load(tag, lights.wl_z() + i), h_x = hn::Load(tag, lights.h_x() + i),
                    h_y = hn::Load(tag, lights.h_y() + i), h_z = hn::Load(tag, lights.h_z() + i);
    const LobeLanes x_sq = hn::Mul(h_x, h_x), y_sq = hn::Mul(h_y, h_y);
    const LobeLanes c = hn::Min(hn::Max(h_z, least), one), across = hn::Max(hn::Add(x_sq, y_sq), lanes_of(1e-12f));
    // (n_x cos^2 phi + n_y sin^2 phi) log c, without a difference of nearly equal numbers at c = 1.
    const LobeLanes per_sq = hn::Div(minus_log(tag, c, hn::Div(across, hn::Add(one, c))), across);
    const LobeLanes x = hn::Mul(x_sq, per_sq), y = hn::Mul(y_sq, per_sq);
    const LobeLanes lobe = exp_nonpositive(tag, hn::Neg(hn::MulAdd(lanes_of(n_x_), x, hn::Mul(lanes_of(n_y_), y))));
    const LobeLanes h_view =
        hn::MulAdd(h_x, lanes_of(wv_.x), hn::MulAdd(h_y, lanes_of(wv_.y), hn::Mul(h_z, lanes_of(wv_.z))));
    const LobeLanes falloff = hn::Mul(hn::Max(h_view, least), hn::Max(wl_z, lanes_of(std::max(wv_.z, 1e-6f))));
    const float norm = std::sqrt((n_x_ + 1) * (n_y_ + 1)) / (8 * kPi);
    const LobeLanes scale = hn::Mul(hn::Mul(lanes_of(norm), wl_z), hn::Load(tag, lights.root_weight() + i));

    LobeSample s{};
    s.value = hn::IfThenElseZero(hn::Gt(wl_z, least), hn::Div(hn::Mul(lobe, scale), falloff));
    if constexpr (slopes) {  // n + 1 = (2 - alpha^2) / alpha^2
      s.by_x = hn::MulSub(lanes_of(2 * (n_x_ + 2)), x, lanes_of((n_x_ + 2) / (n_x_ + 1)));
      s.by_y = hn::MulSub(lanes_of(2 * (n_y_ + 2)), y, lanes_of((n_y_ + 2) / (n_y_ + 1)));
      s.by_tilt = hn::Zero(tag);
    }
    return s;
  }

 private:
  Vec3 wv_;
  float n_x_, n_y_;
};

template <class Lobe>
void FillLobeOf(const ClosureLights& lights, const ClosureLobeShape& shape, float* HWY_RESTRICT value) {
  const LobeTag tag;
  const Lobe lobe(shape, lights);
  for (size_t i = 0; i < lights.padded(); i += hn::Lanes(tag)) {
    hn::Store(lobe.template at<false>(lights, i).value, tag, value + i);
  }
}

template <class Lobe>
void FillLobeSlopesOf(const ClosureLights& lights, const ClosureLobeShape& shape, const LobeChain& chain,
                      float* HWY_RESTRICT out) {
  const LobeTag tag;
  const Lobe lobe(shape, lights);
  const LobeLanes alpha_x = lanes_of(chain.alpha_x), alpha_y = lanes_of(chain.alpha_y), tilt = lanes_of(chain.tilt),
                  stretch_x = lanes_of(chain.stretch_x), stretch_y = lanes_of(chain.stretch_y);
  const size_t row = lights.padded();
  for (size_t i = 0; i < row; i += hn::Lanes(tag)) {
    const LobeSample s = lobe.template at<true>(lights, i);
    hn::Store(s.value, tag, out + i);
    hn::Store(hn::Mul(s.value, hn::MulAdd(s.by_x, alpha_x, hn::Mul(s.by_y, alpha_y))), tag, out + row + i);
    hn::Store(hn::Mul(s.value, hn::Mul(s.by_tilt, tilt)), tag, out + 2 * row + i);
    hn::Store(hn::Mul(s.value, hn::MulAdd(s.by_x, stretch_x, hn::Mul(s.by_y, stretch_y))), tag, out + 3 * row + i);
  }
}

/// Calls `work` with the type of the lobe.
template <class Work>
void with_lobe_type(const ClosureLobeShape& shape, const Work& work) {
  using D = LobeDistribution;
  using M = LobeMasking;
  const auto with_masking = [&]<D d>() {
    shape.masking == M::separable ? work.template operator()<MicrofacetLobe<d, M::separable>>()
                                  : work.template operator()<MicrofacetLobe<d, M::height_correlated>>();
  };
  switch (shape.distribution) {
    case D::ggx:
      return with_masking.template operator()<D::ggx>();
    case D::beckmann:
      return with_masking.template operator()<D::beckmann>();
    case D::ashikhmin_shirley:
      return work.template operator()<AshikhminShirleyLobe>();
  }
}

void FillLobe(const ClosureLights& lights, const ClosureLobeShape& shape, float* value) {
  with_lobe_type(shape, [&]<class Lobe>() { FillLobeOf<Lobe>(lights, shape, value); });
}

void FillLobeSlopes(const ClosureLights& lights, const ClosureLobeShape& shape, const LobeChain& chain, float* out) {
  with_lobe_type(shape, [&]<class Lobe>() { FillLobeSlopesOf<Lobe>(lights, shape, chain, out); });
}

float dot_product(const float* HWY_RESTRICT a, const float* HWY_RESTRICT b, size_t count) {
  const LobeTag tag;
  LobeLanes sum = hn::Zero(tag);
  for (size_t i = 0; i < count; i += hn::Lanes(tag)) {
    sum = hn::MulAdd(hn::Load(tag, a + i), hn::Load(tag, b + i), sum);
  }
  return hn::GetLane(hn::SumOfLanes(tag, sum));
}

void FillProducts(const float* data, int rows, size_t count, const float* const fixed[4], float* gram,
                  float (*moments)[4]) {
  for (int i = 0; i < rows; ++i) {
    const float* row = data + static_cast<size_t>(i) * count;
    for (int j = 0; j <= i; ++j) gram[i * rows + j] = dot_product(row, data + static_cast<size_t>(j) * count, count);
    for (int k = 0; k < 4; ++k) moments[i][k] = dot_product(row, fixed[k], count);
  }
}

}  // namespace velour::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace velour {

namespace {
HWY_EXPORT(FillLobe);
HWY_EXPORT(FillLobeSlopes);
HWY_EXPORT(FillProducts);
}  // namespace

void fill_lobe(const ClosureLights& lights, const ClosureLobeShape& shape, float* value) {
  VELOUR_SIMD_DISPATCH(FillLobe)(lights, shape, value);
}

void fill_lobe_slopes(const ClosureLights& lights, const ClosureLobeShape& shape, const LobeChain& chain, float* out) {
  VELOUR_SIMD_DISPATCH(FillLobeSlopes)(lights, shape, chain, out);
}

void fill_products(const float* data, int rows, size_t count, const float* const fixed[4], float* gram,
                   float (*moments)[4]) {
  VELOUR_SIMD_DISPATCH(FillProducts)(data, rows, count, fixed, gram, moments);
}

}  // namespace velour
#endif  // HWY_ONCE

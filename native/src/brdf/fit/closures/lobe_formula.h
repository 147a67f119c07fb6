// A Glossy BSDF of Cycles with a tilted normal, and its derivatives. The formula is written once: for single directions
// and for loops over arrays, which the compiler turns into SIMD code.
#pragma once

#include <algorithm>
#include <cmath>
#include "math/sphere/vec.h"

namespace velour {

enum class LobeDistribution { ggx, beckmann };

/// Masking and shadowing of microfacets by Smith's function.
enum class LobeMasking {
  separable,          // G1(wv) G1(wl): Blender before 3.5
  height_correlated,  // 1 / (1 + Lambda(wv) + Lambda(wl)): later versions
};

/// Smith's Lambda at t = (alpha tan(theta))^2 [H14 Eq. 72], and its derivative by t.
struct SmithLambda {
  float value, slope;
};

template <LobeDistribution distribution, LobeMasking masking>
inline SmithLambda smith_lambda(float t) {
  if constexpr (distribution == LobeDistribution::ggx) {
    const float root = std::sqrt(1 + t);
    return {0.5f * (root - 1), 0.25f / root};
  } else {
    // Rational approximation [WMLT07]. Versions of Cycles round its threshold, a = 1.6, differently.
    constexpr float kThreshold = masking == LobeMasking::separable ? 0.625f * 0.625f : 0.39f;
    const float safe = std::max(t, 0.5f * kThreshold), a = 1 / std::sqrt(safe);
    const float above = (0.396f * a - 1.259f) * a + 1, below = (2.181f * a + 3.535f) * a;
    const float by_a = ((0.792f * a - 1.259f) * below - above * (4.362f * a + 3.535f)) / (below * below);
    const float share = t < kThreshold ? 0.0f : 1.0f;
    return {share * above / below, share * by_a * -0.5f * a * a * a};
  }
}

/// A lobe at a view in the x-z plane: what does not depend on the light.
struct LobeAtView {
  float alpha_x = 1, alpha_y = 1;             // along and across the plane of incidence
  float sin_tilt = 0, cos_tilt = 1;           // N' = (sin_tilt, 0, cos_tilt)
  float view_x = 0, view_z = 1;               // of wv in the frame of N'
  float lambda = 0;                           // Smith's Lambda of wv
  float lambda_by_x = 0, lambda_by_tilt = 0;  // its derivatives by log(alpha_x) and by the tilt in radians
};

/// Value of a lobe, D G / (4 wv.N'), and derivatives of its logarithm.
struct LobeSample {
  float value;       // 1/sr; the cosine of the light is not a factor
  float by_x, by_y;  // by log(alpha_x) and log(alpha_y)
  float by_tilt;     // by the tilt in radians
};

/// `theta_v` and `tilt` in radians; wv.N' must be positive.
LobeAtView lobe_at_view(LobeDistribution distribution, LobeMasking masking, float alpha_x, float alpha_y, float tilt,
                        float theta_v);

/// `wl` and the half vector `h` in the untilted frame, wl above the horizon. The value is 0 behind N'.
template <LobeDistribution distribution, LobeMasking masking>
inline LobeSample lobe_sample(const LobeAtView& lobe, float wl_x, float wl_y, float wl_z, float h_x, float h_y,
                              float h_z) {
  const float light_x = wl_x * lobe.cos_tilt - wl_z * lobe.sin_tilt,
              light_z = wl_x * lobe.sin_tilt + wl_z * lobe.cos_tilt;
  const float half_x = h_x * lobe.cos_tilt - h_z * lobe.sin_tilt, half_z = h_x * lobe.sin_tilt + h_z * lobe.cos_tilt;
  const float safe_light = std::max(light_z, 1e-6f), c = std::max(half_z, 1e-6f);
  const float lit = light_z > 1e-6f && half_z > 1e-6f ? 1.0f : 0.0f;
  const float x_sq = lobe.alpha_x * lobe.alpha_x, y_sq = lobe.alpha_y * lobe.alpha_y;
  const float area = kPi * lobe.alpha_x * lobe.alpha_y;
  const float ex = half_x * half_x / x_sq, ey = h_y * h_y / y_sq;

  LobeSample s;
  if constexpr (distribution == LobeDistribution::ggx) {
    const float q = ex + ey + c * c, per_q = 1 / q;
    s.value = per_q * per_q / area;
    s.by_x = 4 * ex * per_q - 1;
    s.by_y = 4 * ey * per_q - 1;
    s.by_tilt = 4 * half_x * c * per_q * (1 / x_sq - 1);
  } else {
    const float per_c = 1 / c, per_c_sq = per_c * per_c, slope = half_x * per_c;
    const float x = ex * per_c_sq, y = ey * per_c_sq;
    s.value = std::exp(-(x + y)) * per_c_sq * per_c_sq / area;
    s.by_x = 2 * x - 1;
    s.by_y = 2 * y - 1;
    s.by_tilt = 2 * slope * (1 / x_sq + x + y) - 4 * slope;
  }

  const float tx = light_x / safe_light, ty = wl_y / safe_light;
  const float t_x = x_sq * tx * tx, t_y = y_sq * ty * ty;
  const SmithLambda of_light = smith_lambda<distribution, masking>(t_x + t_y);
  const float light_by_tilt = of_light.slope * -2 * tx * (x_sq + t_x + t_y);
  float per_view, per_light;  // factors of the logarithmic derivatives
  if constexpr (masking == LobeMasking::separable) {
    per_view = 1 / (1 + lobe.lambda);
    per_light = 1 / (1 + of_light.value);
    s.value *= per_view * per_light;
  } else {
    per_view = per_light = 1 / (1 + lobe.lambda + of_light.value);
    s.value *= per_view;
  }
  s.value *= lit / (4 * lobe.view_z);
  s.by_x -= per_view * lobe.lambda_by_x + per_light * of_light.slope * 2 * t_x;
  s.by_y -= per_light * of_light.slope * 2 * t_y;
  s.by_tilt -= per_view * lobe.lambda_by_tilt + per_light * light_by_tilt + lobe.view_x / lobe.view_z;
  return s;
}

/// Calls `work` with distribution and masking as integral constants.
template <class Work>
decltype(auto) with_lobe_kind(LobeDistribution distribution, LobeMasking masking, const Work& work) {
  using D = LobeDistribution;
  using M = LobeMasking;
  const auto with_masking = [&]<D d>() -> decltype(auto) {
    return masking == M::separable ? work.template operator()<d, M::separable>()
                                   : work.template operator()<d, M::height_correlated>();
  };
  return distribution == D::ggx ? with_masking.template operator()<D::ggx>()
                                : with_masking.template operator()<D::beckmann>();
}

}  // namespace velour

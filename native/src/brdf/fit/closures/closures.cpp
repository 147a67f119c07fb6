#include "brdf/fit/closures/closures.h"

#include <algorithm>
#include <cmath>

namespace velour {

LobeAtView lobe_at_view(LobeDistribution distribution, LobeMasking masking, float alpha_x, float alpha_y, float tilt,
                        float theta_v) {
  LobeAtView lobe{.alpha_x = alpha_x, .alpha_y = alpha_y, .sin_tilt = std::sin(tilt), .cos_tilt = std::cos(tilt)};
  lobe.view_x = std::sin(theta_v - tilt);
  lobe.view_z = std::max(std::cos(theta_v - tilt), 1e-6f);
  const float tangent = lobe.view_x / lobe.view_z, x_sq = alpha_x * alpha_x, t = x_sq * tangent * tangent;
  const SmithLambda of_view =
      with_lobe_kind(distribution, masking, [&]<LobeDistribution d, LobeMasking m>() { return smith_lambda<d, m>(t); });
  lobe.lambda = of_view.value;
  lobe.lambda_by_x = of_view.slope * 2 * t;
  lobe.lambda_by_tilt = of_view.slope * -2 * tangent * (x_sq + t);
  return lobe;
}

float lowest_closure_tilt(float theta_v) {
  constexpr float kLeastRise = 0.01f;
  const float rise = std::min(0.9f * std::cos(theta_v), kLeastRise);
  return 0.5f * (theta_v - std::acos(std::clamp(rise, 0.0f, 1.0f)));
}

namespace {

/// Value of a curve at theta_v, held at the ends.
template <class T>
T closure_value(const ClosureCurve<T>& curve, float theta_v) {
  const float at = std::clamp(theta_v / (0.5f * kPi), 0.0f, 1.0f) * (kClosureSamples - 1);
  const size_t i = std::min(static_cast<size_t>(at), static_cast<size_t>(kClosureSamples - 2));
  const float t = at - static_cast<float>(i);
  return curve[i] * (1 - t) + curve[i + 1] * t;
}

LobeSample lobe_sample_of(LobeDistribution distribution, LobeMasking masking, const LobeAtView& lobe, const Vec3& wl,
                          const Vec3& h) {
  return with_lobe_kind(distribution, masking, [&]<LobeDistribution d, LobeMasking m>() {
    return lobe_sample<d, m>(lobe, wl.x, wl.y, wl.z, h.x, h.y, h.z);
  });
}

/// Half vector of an isotropic or stretched lobe in its own frame; `u` in (0, 1), density D cos.
Vec3 lobe_half_vector(LobeDistribution distribution, const LobeAtView& lobe, const Vec2& u) {
  const float tan_sq = distribution == LobeDistribution::ggx ? u.x / (1 - u.x) : -std::log(1 - u.x);
  const float slope = std::sqrt(tan_sq), phi = 2 * kPi * u.y;
  return glm::normalize(Vec3(slope * lobe.alpha_x * std::cos(phi), slope * lobe.alpha_y * std::sin(phi), 1));
}

/// D cos of `h` in the frame of the lobe, per solid angle.
float lobe_half_density(LobeDistribution distribution, const LobeAtView& lobe, const Vec3& h) {
  const Vec2 slope = Vec2(h.x / lobe.alpha_x, h.y / lobe.alpha_y) / h.z;
  const float e = glm::dot(slope, slope), c_sq = h.z * h.z;
  const float falloff = distribution == LobeDistribution::ggx ? 1 / ((1 + e) * (1 + e)) : std::exp(-e);
  return falloff / (kPi * lobe.alpha_x * lobe.alpha_y * c_sq * h.z);
}

}  // namespace

ClosuresAtView::ClosuresAtView(const ClosureNetwork& network, LobeMasking masking, float theta_v)
    : wv_(direction(theta_v, 0)), diffuse_(closure_value(network.diffuse, theta_v)), masking_(masking) {
  for (const ClosureLobe& lobe : network.lobes) {
    const float roughness = closure_value(lobe.roughness, theta_v), alpha = roughness * roughness;
    const float stretch = std::exp(closure_value(lobe.anisotropy, theta_v));
    lobes_.push_back(
        {lobe_at_view(lobe.distribution, masking, std::min(alpha * stretch, 1.0f), std::min(alpha / stretch, 1.0f),
                      closure_value(lobe.tilt, theta_v) * theta_v, theta_v),
         lobe.distribution, closure_value(lobe.weight, theta_v)});
  }
}

Rgb ClosuresAtView::f_cos(const Vec3& wl) const {
  if (!(wl.z > 0)) return Rgb(0);
  const Vec3 h = glm::normalize(wl + wv_);
  Rgb sum = diffuse_ * (wl.z / kPi);
  for (const Lobe& lobe : lobes_) {
    sum += lobe.weight * lobe_sample_of(lobe.distribution, masking_, lobe.shape, wl, h).value;
  }
  return sum;
}

float ClosuresAtView::lobe_albedo(size_t k) const {
  constexpr int kHalfVectors = 8192;  // a rank-1 lattice
  const auto& [shape, distribution, weight] = lobes_[k];
  double sum = 0;
  for (int i = 0; i < kHalfVectors; ++i) {
    const double across = 0.6180339887498949 * i;
    const Vec2 u((static_cast<float>(i) + 0.5f) / kHalfVectors, static_cast<float>(across - std::floor(across)));
    const Vec3 own = lobe_half_vector(distribution, shape, u);
    const Vec3 h(own.x * shape.cos_tilt + own.z * shape.sin_tilt, own.y,
                 own.z * shape.cos_tilt - own.x * shape.sin_tilt);
    const float v_h = glm::dot(wv_, h);
    const Vec3 wl = 2 * v_h * h - wv_;
    if (!(v_h > 0) || !(wl.z > 0)) continue;
    const float density = lobe_half_density(distribution, shape, own) / (4 * v_h);
    if (density > 0) sum += lobe_sample_of(distribution, masking_, shape, wl, h).value / density;
  }
  return static_cast<float>(sum / kHalfVectors);
}

Rgb ClosuresAtView::albedo() const {
  Rgb sum = diffuse_;
  for (size_t k = 0; k < lobes_.size(); ++k) {
    if (lobes_[k].weight != Rgb(0)) sum += lobes_[k].weight * lobe_albedo(k);
  }
  return sum;
}

Rgb closure_f_cos(const ClosureNetwork& network, LobeMasking masking, const Vec3& wv, const Vec3& wl) {
  if (!(wv.z > 0) || !(wl.z > 0)) return Rgb(0);
  const float sine = std::hypot(wv.x, wv.y);
  const Vec2 to_viewer = sine > 0 ? Vec2(wv.x, wv.y) / sine : Vec2(1, 0);
  const Vec3 turned(wl.x * to_viewer.x + wl.y * to_viewer.y, wl.y * to_viewer.x - wl.x * to_viewer.y, wl.z);
  return ClosuresAtView(network, masking, std::atan2(sine, wv.z)).f_cos(turned);
}

float closure_albedo(const ClosureNetwork& network, LobeMasking masking, float theta_v, int channel) {
  return ClosuresAtView(network, masking, theta_v).albedo()[channel];
}

}  // namespace velour

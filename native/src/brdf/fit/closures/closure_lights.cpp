#include "brdf/fit/closures/closure_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include "math/sphere/directions.h"
#include "math/sphere/random.h"

namespace velour {

namespace {

Vec3 turned_about_z(const Vec3& w, float phi) {
  const float c = std::cos(phi), s = std::sin(phi);
  return {c * w.x - s * w.y, s * w.x + c * w.y, w.z};
}

}  // namespace

std::vector<float> closure_azimuths(const ClosureSource& source, int count) {
  if (source.isotropic) return {0};
  std::vector<float> azimuths;
  for (int i = 0; i < count; ++i) {
    const double turns = 0.1 + kGoldenRatio * i;  // no two azimuths mirror each other, as steps of equal size do
    azimuths.push_back(2 * kPi * static_cast<float>(turns - std::floor(turns)));
  }
  return azimuths;
}

std::vector<Rgb> source_values(const ClosureSource& source, const Vec3& wv, std::span<const Vec3> wl) {
  std::vector<Rgb> f_cos(wl.size());
  source.f(wv, wl, f_cos);
  for (size_t i = 0; i < wl.size(); ++i) f_cos[i] = glm::max(f_cos[i], Rgb(0)) * wl[i].z;
  return f_cos;
}

namespace {

constexpr HighlightWidths kWidest{0.04f, 0.25f};

/// Smallest angle from `axis` in `angles` at which luminance falls to half, toward either side in the plane of
/// incidence, divided by that at which a lobe of width 1 does.
float half_width(const ClosureSource& source, const Vec3& wv, std::span<const float> angles, float per_width,
                 const auto& light_at) {
  std::vector<Vec3> wl{light_at(0.0f)};
  for (const float angle : angles) {
    wl.push_back(light_at(angle));
    wl.push_back(light_at(-angle));
  }
  const std::vector<Rgb> f_cos = source_values(source, wv, wl);
  const float half = 0.5f * luminance(f_cos[0]);
  for (size_t i = 0; i < angles.size(); ++i) {
    if (luminance(f_cos[2 * i + 1]) < half && luminance(f_cos[2 * i + 2]) < half) return angles[i] / per_width;
  }
  return 1;
}

}  // namespace

HighlightWidths highlight_widths(const ClosureSource& source) {
  constexpr float kGgxHalf = 0.6436f;  // tan(theta_h) / alpha where D falls to half
  std::array<float, 16> angles{};      // 0.002 to 0.2 radians
  for (size_t i = 0; i < angles.size(); ++i) angles[i] = 0.002f * std::pow(100.0f, static_cast<float>(i) / 15);
  HighlightWidths widths = kWidest;
  for (const float degrees : {12.0f, 32.0f, 52.0f}) {
    const float theta = radians_from(degrees);
    for (const float phi : closure_azimuths(source)) {
      const Vec3 wv = direction(theta, phi);
      const auto mirrored = [&](float angle) { return direction(theta + 2 * angle, phi + kPi); };
      const auto returned = [&](float angle) { return direction(theta + angle, phi); };
      widths.mirror = std::min(widths.mirror, half_width(source, wv, angles, kGgxHalf, mirrored));
      widths.viewer = std::min(widths.viewer, half_width(source, wv, angles, kGgxHalf, returned));
    }
  }
  return widths;
}

namespace {

/// Density of D cos about an axis, GGX of `alpha`, at cosine `c`.
double axis_density(double c, double alpha) {
  const double a_sq = alpha * alpha, q = c * c * (a_sq - 1) + 1;
  return c > 0 ? a_sq * c / (kPiD * q * q) : 0;
}

/// Direction about +z with axis_density().
Vec3 about_z(const Vec2& u, float alpha) {
  const float slope = alpha * std::sqrt(u.x / (1 - u.x));
  return glm::normalize(Vec3(slope * std::cos(2 * kPi * u.y), slope * std::sin(2 * kPi * u.y), 1));
}

/// Numbers of lights of the parts of the mixture.
struct LightMixture {
  int uniform, mirror, viewer;  // `mirror` lights of each of `alpha`
  std::array<float, 3> alpha;
  float viewer_alpha;

  double density(const Vec3& wl, const Vec3& wv) const {
    const Vec3 h = glm::normalize(wl + wv);
    double sum = uniform / (2 * kPiD) + viewer * axis_density(glm::dot(wl, wv), viewer_alpha);
    for (const float a : alpha) sum += mirror * axis_density(h.z, a) / (4 * glm::dot(wv, h));
    return sum;
  }
};

}  // namespace

WeightedLights closure_lights(const HighlightWidths& widths, float theta_v, int count, float phi_v) {
  constexpr float kWideAlpha = 0.35f;
  const LightMixture mixture{3 * count / 10,
                             count / 5,
                             count / 10,
                             {widths.mirror, std::sqrt(widths.mirror * kWideAlpha), kWideAlpha},
                             widths.viewer};
  const Vec3 wv = direction(theta_v, 0);
  WeightedLights lights;
  const auto add = [&](uint64_t key, int n, const auto& direction_of_point) {
    std::vector<Vec2> points(static_cast<size_t>(n));
    sobol_points(key, 0, points);
    for (const Vec2& u : points) {
      const Vec3 wl = direction_of_point(u);
      if (wl.z > 1e-4f) lights.wl.push_back(wl);
    }
  };
  add(1, mixture.uniform, [](const Vec2& u) {
    const float s = std::sqrt(std::max(1 - u.x * u.x, 0.0f)), phi = 2 * kPi * u.y;
    return Vec3(s * std::cos(phi), s * std::sin(phi), u.x);
  });
  for (size_t i = 0; i < mixture.alpha.size(); ++i) {
    add(2 + i, mixture.mirror, [&](const Vec2& u) {
      const Vec3 h = about_z(u, mixture.alpha[i]);
      return glm::dot(wv, h) > 1e-4f ? glm::normalize(2 * glm::dot(wv, h) * h - wv) : Vec3(0);
    });
  }
  add(2 + mixture.alpha.size(), mixture.viewer, [&](const Vec2& u) {
    const Vec3 d = about_z(u, mixture.viewer_alpha), across(wv.z, 0, -wv.x);
    return d.x * across + d.y * Vec3(0, 1, 0) + d.z * wv;
  });
  for (const Vec3& wl : lights.wl) lights.weight.push_back(1 / mixture.density(wl, wv));
  if (phi_v != 0) {
    for (Vec3& wl : lights.wl) wl = turned_about_z(wl, phi_v);
  }
  return lights;
}

ClosureLights::ClosureLights(float theta_v, const WeightedLights& lights, float phi_v)
    : theta_v_(theta_v),
      phi_v_(phi_v),
      padded_((lights.wl.size() + kPadding - 1) / kPadding * kPadding),
      data_(aligned_zeros(7 * padded_)) {
  const Vec3 wv = direction(theta_v, phi_v);
  for (size_t i = 0; i < padded_; ++i) {
    const bool padding = i >= lights.wl.size();
    const Vec3 wl = padding ? Vec3(0, 0, 1) : lights.wl[i], h = glm::normalize(wl + wv);
    const float weight = padding ? 0.0f : static_cast<float>(std::sqrt(lights.weight[i]));
    const float values[7] = {wl.x, wl.y, wl.z, h.x, h.y, h.z, weight};
    for (size_t r = 0; r < 7; ++r) data_.data()[r * padded_ + i] = values[r];
  }
}

namespace {

/// Sums over the values of a target, which include root_weight.
void set_norms(ClosureTarget& target) {
  const size_t padded = target.lights.padded();
  target.norm_sq = Vec3d(0);
  target.norm_sq_luminance = 0;
  for (size_t i = 0; i < padded; ++i) {
    const Vec3d value(target.channel(0)[i], target.channel(1)[i], target.channel(2)[i]);
    const double bright = luminance(Rgb(value));
    target.norm_sq += value * value;
    target.norm_sq_luminance += bright * bright;
  }
}

}  // namespace

ClosureTarget closure_target(const ClosureSource& source, const HighlightWidths& widths, float theta_v, int count,
                             float phi_v) {
  const WeightedLights lights = closure_lights(widths, theta_v, count, phi_v);
  const std::vector<Rgb> f_cos = source_values(source, direction(theta_v, phi_v), lights.wl);
  ClosureTarget target{.lights = ClosureLights(theta_v, lights, phi_v),
                       .values = AlignedArray<float>(0),
                       .integral = AlignedArray<float>(0)};
  const size_t padded = target.lights.padded();
  const float* root_weight = std::as_const(target.lights).root_weight();
  target.values = aligned_zeros(3 * padded);
  target.integral = aligned_zeros(padded);
  std::copy(root_weight, root_weight + padded, target.integral.data());
  for (size_t i = 0; i < f_cos.size(); ++i) {
    target.albedo += lights.weight[i] * Vec3d(f_cos[i]);
    for (int c = 0; c < 3; ++c) {
      target.values.data()[static_cast<size_t>(c) * padded + i] = root_weight[i] * f_cos[i][c];
    }
  }
  set_norms(target);
  return target;
}

void emphasize_dim(ClosureTarget& target, double share) {
  constexpr double kDark = 0.01;  // of the mean: darker lights count as much as these
  const double albedo = luminance(Rgb(target.albedo));
  if (!(albedo > 0)) return;
  const size_t padded = target.lights.padded();
  float* root_weight = target.lights.root_weight();
  for (size_t i = 0; i < padded; ++i) {
    if (root_weight[i] <= 0) continue;
    const Rgb value(target.channel(0)[i], target.channel(1)[i], target.channel(2)[i]);
    const double f_cos = luminance(value) / root_weight[i];
    // d sqrt(f) = df / (2 sqrt(f)); the squared norm of the root is the albedo.
    const double of_root = 0.25 * target.norm_sq_luminance / (albedo * (f_cos + kDark * albedo / kPiD));
    const auto factor = static_cast<float>(std::sqrt(1 + share * of_root));
    root_weight[i] *= factor;
    target.integral.data()[i] /= factor;
    for (size_t c = 0; c < 3; ++c) target.values.data()[c * padded + i] *= factor;
  }
  set_norms(target);
}

}  // namespace velour

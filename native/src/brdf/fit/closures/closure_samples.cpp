#include "brdf/fit/closures/closure_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include "base/parallel.h"
#include "math/sphere/sobol.h"

namespace velour {

namespace {

constexpr int kClosureViews = 36, kClosureTurns = 8;

Vec3 turned_about_z(const Vec3& w, float phi) {
  const float c = std::cos(phi), s = std::sin(phi);
  return {c * w.x - s * w.y, s * w.x + c * w.y, w.z};
}

}  // namespace

std::vector<Rgb> closure_values(const ClosureSource& source, bool isotropic, float theta_v, std::span<const Vec3> wl) {
  std::vector<Rgb> sum(wl.size(), Rgb(0)), f(wl.size());
  std::vector<Vec3> turned(wl.size());
  const int turns = isotropic ? 1 : kClosureTurns;
  for (int t = 0; t < turns; ++t) {
    const float phi = 2 * kPi * (static_cast<float>(t) + (isotropic ? 0.0f : 0.25f)) / static_cast<float>(turns);
    for (size_t i = 0; i < wl.size(); ++i) turned[i] = turned_about_z(wl[i], phi);
    source(turned_about_z(direction(theta_v, 0), phi), turned, f);
    for (size_t i = 0; i < wl.size(); ++i) sum[i] += glm::max(f[i], Rgb(0)) * wl[i].z / static_cast<float>(turns);
  }
  return sum;
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

constexpr std::array<float, 3> kLightAlphas{0.04f, 0.12f, 0.35f};
constexpr float kRetroAlpha = 0.25f;

/// Numbers of lights of the parts of the mixture.
struct LightMixture {
  int uniform, mirror, retro;  // `mirror` lights of each of kLightAlphas

  double density(const Vec3& wl, const Vec3& wv) const {
    const Vec3 h = glm::normalize(wl + wv);
    double sum = uniform / (2 * kPiD) + retro * axis_density(glm::dot(wl, wv), kRetroAlpha);
    for (const float alpha : kLightAlphas) sum += mirror * axis_density(h.z, alpha) / (4 * glm::dot(wv, h));
    return sum;
  }
};

}  // namespace

WeightedLights closure_lights(float theta_v, int count) {
  const LightMixture mixture{3 * count / 10, count / 5, count / 10};
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
  for (size_t i = 0; i < kLightAlphas.size(); ++i) {
    add(2 + i, mixture.mirror, [&](const Vec2& u) {
      const Vec3 h = about_z(u, kLightAlphas[i]);
      return glm::dot(wv, h) > 1e-4f ? glm::normalize(2 * glm::dot(wv, h) * h - wv) : Vec3(0);
    });
  }
  add(2 + kLightAlphas.size(), mixture.retro, [&](const Vec2& u) {
    const Vec3 d = about_z(u, kRetroAlpha), across(wv.z, 0, -wv.x);
    return d.x * across + d.y * Vec3(0, 1, 0) + d.z * wv;
  });
  for (const Vec3& wl : lights.wl) lights.weight.push_back(1 / mixture.density(wl, wv));
  return lights;
}

namespace {

void set_light(ClosureViewSamples& s, size_t i, const Vec3& wl, const Vec3& wv, double weight, const Rgb& f_cos) {
  const Vec3 h = glm::normalize(wl + wv);
  s.wl_x[i] = wl.x, s.wl_y[i] = wl.y, s.wl_z[i] = wl.z;
  s.h_x[i] = h.x, s.h_y[i] = h.y, s.h_z[i] = h.z;
  s.root_weight[i] = static_cast<float>(std::sqrt(weight));
  for (int c = 0; c < 3; ++c) s.target[c][i] = s.root_weight[i] * f_cos[c];
}

ClosureViewSamples samples_at(const ClosureSource& source, bool isotropic, float theta_v) {
  ClosureViewSamples s{};
  s.theta_v = theta_v;
  const WeightedLights lights = closure_lights(theta_v, ClosureViewSamples::kMax);
  const std::vector<Rgb> f_cos = closure_values(source, isotropic, theta_v, lights.wl);
  s.count = static_cast<int>(lights.wl.size());
  for (size_t i = 0; i < lights.wl.size(); ++i) {
    set_light(s, i, lights.wl[i], direction(theta_v, 0), lights.weight[i], f_cos[i]);
    for (int c = 0; c < 3; ++c) s.albedo[c] += lights.weight[i] * f_cos[i][c];
  }
  return s;
}

struct TargetNorms {
  double channel[3] = {}, luminance = 0;  // squared
};

TargetNorms norms_of(const ClosureViewSamples& s) {
  TargetNorms norms;
  for (int i = 0; i < s.count; ++i) {
    const Rgb t(s.target[0][i], s.target[1][i], s.target[2][i]);
    for (int c = 0; c < 3; ++c) norms.channel[c] += static_cast<double>(t[c]) * t[c];
    norms.luminance += static_cast<double>(luminance(t)) * luminance(t);
  }
  return norms;
}

/// Sets the inverse norms. Views and channels that are nearly black count less: norms have lower bounds relative to the
/// largest of all views, and to the view's luminance.
void set_norms(std::vector<ClosureViewSamples>& views) {
  constexpr double kLeastView = 1e-3, kLeastChannel = 0.02;
  std::vector<TargetNorms> norms;
  double largest = 0, largest_albedo = 0;
  for (const ClosureViewSamples& s : views) {
    norms.push_back(norms_of(s));
    largest = std::max(largest, norms.back().luminance);
    largest_albedo = std::max({largest_albedo, s.albedo[0], s.albedo[1], s.albedo[2]});
  }
  if (!(largest > 0)) return views.clear();
  for (size_t v = 0; v < views.size(); ++v) {
    const double least = std::max(norms[v].luminance, kLeastView * kLeastView * largest);
    const double least_albedo = kLeastChannel * std::max({*std::max_element(views[v].albedo, views[v].albedo + 3),
                                                          kLeastView * largest_albedo});
    views[v].inverse_norm_sq_luminance = 1 / least;
    for (int c = 0; c < 3; ++c) {
      views[v].inverse_norm_sq[c] = 1 / std::max(norms[v].channel[c], kLeastChannel * kLeastChannel * least);
      views[v].inverse_albedo_sq[c] = std::pow(std::max(views[v].albedo[c], least_albedo), -2);
    }
  }
}

}  // namespace

std::vector<ClosureViewSamples> closure_samples(const ClosureSource& source, bool isotropic, int threads,
                                                Progress& progress) {
  std::vector<ClosureViewSamples> views(kClosureViews);
  parallel_for_each(views.size(), threads, progress, [&](size_t i) {
    views[i] = samples_at(source, isotropic, radians_from(1.25f + 2.5f * static_cast<float>(i)));
  });
  set_norms(views);
  return views;
}

}  // namespace velour

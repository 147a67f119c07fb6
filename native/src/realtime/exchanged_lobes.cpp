#include "realtime/exchanged_lobes.h"

#include <algorithm>
#include <cmath>

#include "sphere/directions.h"
#include "sphere/frame.h"
#include "srbf/kernel.h"

namespace velour {
namespace {

constexpr int kLights = 300;  // on the hemisphere: starting points of Newton's method
constexpr int kMaxSteps = 8;
constexpr double kFarthest = 0.3;                          // maximum length of a step in radians
constexpr double kBroadest = 2;                            // minimum bandwidth of a peak
constexpr double kMinLogGrowth = -2, kMaxLogGrowth = 1.5;  // bounds of the logarithm of growth()

double sum_of(const Vec3d& color) { return color.x + color.y + color.z; }

/// Logarithm of the sum of a term's channels; `own`: its parameters at the light.
double log_value(const WarpedLobe& own, const Vec3d& wl, const Vec3d& wv) {
  return std::log(0.5 * sum_of(own.coefficient)) - own.bandwidth * one_minus_dot(warped(own, wv, wl), own.center);
}

/// Quadratic approximation of a function of two variables at 0, by finite differences.
struct Quadratic {
  double at;
  glm::dvec2 slope;
  glm::dmat2 curvature;  // of the negated function

  template <typename Value>
  Quadratic(const Value& f, double h) : at(f(0, 0)) {
    const double right = f(h, 0), left = f(-h, 0), ahead = f(0, h), behind = f(0, -h);
    const double mixed = (f(h, h) - f(h, -h) - f(-h, h) + f(-h, -h)) / 4;
    slope = glm::dvec2(right - left, ahead - behind) / (2 * h);
    curvature = glm::dmat2(2 * at - right - left, -mixed, -mixed, 2 * at - ahead - behind) / (h * h);
  }
  double least_curvature() const {
    const double middle = (curvature[0][0] + curvature[1][1]) / 2;
    return middle - std::hypot((curvature[0][0] - curvature[1][1]) / 2, curvature[0][1]);
  }
  glm::dvec2 step_to_peak() const {
    const glm::dvec2 step = glm::inverse(curvature) * slope;
    return step * std::min(1.0, kFarthest / std::max(glm::length(step), 1e-12));
  }
};

/// Inverse square root of a symmetric positive definite matrix.
glm::dmat2 inverse_root(const glm::dmat2& m) {
  const double root = std::sqrt(glm::determinant(m)), trace = std::sqrt(m[0][0] + m[1][1] + 2 * root);
  return glm::inverse((m + glm::dmat2(root)) / trace);
}

/// Lifts `wl` to `least_cosine`: there are no parameters below the horizon, so peaks there are extrapolated from above.
Vec3d lifted(const Vec3d& wl, double least_cosine) {
  if (wl.z >= least_cosine) return wl;
  const double planar = std::sqrt((1 - least_cosine * least_cosine) / (wl.x * wl.x + wl.y * wl.y));
  return {planar * wl.x, planar * wl.y, least_cosine};
}

/// A lobe at the view, in the space of the parameters `own` at `wl`, centered on the argument of `wl`.
WarpedLobe argument_of(const WarpedLobe& own, const Vec3d& wl, const Vec3d& wv) {
  WarpedLobe seen;
  seen.space = own.space;
  if (own.space == LobeSpace::half) seen.stretch = own.stretch;
  seen.center = warped(seen, wl, wv);
  return seen;
}

}  // namespace

ExchangedLobes::ExchangedLobes(const ParametricBrdf& brdf) : brdf_(brdf) {
  for (const Vec3& wl : hemisphere_fibonacci(kLights)) lights_.push_back({Vec3d(wl), lobes_at(brdf, Vec3d(wl))});
}

Vec3d ExchangedLobes::value(int lobe, const Vec3d& wl, const Vec3d& wv) const {
  const WarpedLobe own = lobe_at(brdf_, wl, lobe);
  return 0.5 * own.coefficient * warped_kernel(own, wv, wl);
}

Vec3d ExchangedLobes::brightest(int lobe, const Vec3d& wv) const {
  const auto value = [&](const Light& light) {
    return log_value(light.lobes[static_cast<size_t>(lobe)], light.wl, wv);
  };
  const auto is_less = [&](const Light& a, const Light& b) { return value(a) < value(b); };
  return std::max_element(lights_.begin(), lights_.end(), is_less)->wl;
}

std::optional<ReachedLobe> ExchangedLobes::at(int lobe, const Vec3d& wv) const {
  Vec3d wl = brightest(lobe, wv);
  for (int i = 1;; ++i) {
    WarpedLobe own = lobe_at(brdf_, wl, lobe);
    const double deviation = 1 / std::sqrt(own.bandwidth), h = std::min(0.3 * deviation, 0.1);
    wl = lifted(wl, 1.5 * h);
    own = lobe_at(brdf_, wl, lobe);
    WarpedLobe seen = argument_of(own, wl, wv);
    const Frame frame = Frame::about(Vec3(seen.center));
    const auto light = [&](double x, double y) {
      return unwarped(seen, glm::normalize(seen.center + x * Vec3d(frame.x) + y * Vec3d(frame.y)), wv);
    };
    const auto log_value_at = [&](double x, double y) {
      const auto w = light(x, y);
      return w ? log_value(lobe_at(brdf_, *w, lobe), *w, wv) : -1e3;
    };
    const Quadratic log_g(log_value_at, h);
    if (!(log_g.least_curvature() > kBroadest)) return std::nullopt;
    const glm::dvec2 step = log_g.step_to_peak();
    const auto peak = light(step.x, step.y);
    if (!peak) return std::nullopt;
    wl = *peak;
    if (i < kMaxSteps && glm::length(step) > 0.02 * deviation) continue;
    seen.center = warped(seen, wl, wv);
    seen.coefficient = own.coefficient / sum_of(own.coefficient) * std::exp(log_g.at + glm::dot(log_g.slope, step) / 2);
    return reached(seen, inverse_root(log_g.curvature), wv);
  }
}

double ExchangedLobes::growth(int lobe, const ReachedLobe& seen, const Vec3d& wl, const Vec3d& wv) const {
  const double log_growth = log_value(lobe_at(brdf_, wl, lobe), wl, wv) - std::log(sum_of(seen.value(wl, wv)));
  return std::exp(std::clamp(log_growth, kMinLogGrowth, kMaxLogGrowth));
}

}  // namespace velour

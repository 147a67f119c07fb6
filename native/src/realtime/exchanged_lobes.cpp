#include "realtime/exchanged_lobes.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>
#include "math/sphere/directions.h"
#include "math/sphere/frame.h"
#include "math/srbf/kernel.h"

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

namespace {

constexpr int kPoints = 1500;               // on the sphere
constexpr double kBandwidth = 14;           // standard deviation of 15 degrees
constexpr double kApart = 25 * kPiD / 180;  // between rings, and between the Gaussians of a ring
constexpr double kNarrowest = 300;          // maximum bandwidth of own Gaussians whose colors change
constexpr double kStay = 1e-3;              // penalty of a color change, relative to the Gaussian's squared norm
constexpr double kRidge = 1e-5;             // relative to the mean diagonal of the Gram matrix; keeps weights small

std::vector<LightGaussian> rings() {
  std::vector<LightGaussian> gaussians;
  constexpr int kCounts[] = {1, 6, 12, 18};
  for (int ring = 0; ring < 4; ++ring) {
    const double theta = ring * kApart;
    for (int i = 0; i < kCounts[ring]; ++i) {
      const double phi = 2 * kPiD * i / kCounts[ring];
      const Vec3d center(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      gaussians.push_back({.center = center, .bandwidth = kBandwidth, .color = Vec3d(1.0), .is_used = true});
    }
  }
  return gaussians;
}

Eigen::RowVectorXd density_at(const LightGaussian& g, const std::vector<Vec3d>& points) {
  Eigen::RowVectorXd values(static_cast<Eigen::Index>(points.size()));
  const double scale = 1 / kernel_integral(Kernel::gaussian, g.bandwidth);
  for (Eigen::Index p = 0; p < values.size(); ++p) {
    const double apart = one_minus_dot(g.center, points[static_cast<size_t>(p)]);
    values[p] = scale * kernel_value(Kernel::gaussian, g.bandwidth, apart);
  }
  return values;
}

}  // namespace

BroadPart::BroadPart() : gaussians_(rings()) {
  for (const Vec3& w : sphere_fibonacci(kPoints)) points_.emplace_back(w);
  values_.resize(kLobes, kPoints);
  for (int p = 0; p < kPoints; ++p) values_(0, p) = std::max(points_[static_cast<size_t>(p)].z, 0.0) / kPiD;
  for (int g = 0; g < kGaussians; ++g) values_.row(g + 1) = density_at(gaussians_[static_cast<size_t>(g)], points_);
  Eigen::MatrixXd gram = values_ * values_.transpose();
  gram.diagonal().array() += kRidge * gram.trace() / kLobes;
  solve_ = gram.ldlt().solve(values_);
}

BroadPart::Fitted BroadPart::fitted(const std::function<Vec3d(const Vec3d&)>& slice,
                                    std::span<LightGaussian> own) const {
  Eigen::MatrixXd left(kPoints, 3);
  for (int p = 0; p < kPoints; ++p) {
    const Vec3d value = slice(points_[static_cast<size_t>(p)]);
    for (int c = 0; c < 3; ++c) left(p, c) = value[c];
  }
  std::vector<LightGaussian*> mended;
  for (LightGaussian& g : own) {
    const Eigen::RowVectorXd density = density_at(g, points_);
    left -= density.transpose() * Eigen::RowVector3d(g.color.x, g.color.y, g.color.z);
    if (g.bandwidth < kNarrowest && g.is_used) mended.push_back(&g);
  }
  if (!mended.empty()) mend(mended, left);
  const Eigen::MatrixXd weights = solve_ * left;
  const auto color = [&](int i) { return Vec3d(weights(i, 0), weights(i, 1), weights(i, 2)); };
  Fitted fitted{.cosine = color(0), .gaussians = gaussians_};
  for (int g = 0; g < kGaussians; ++g) fitted.gaussians[static_cast<size_t>(g)].color = color(g + 1);
  return fitted;
}

/// Adjusts the colors of `own` to what the fixed Gaussians cannot represent of `left`, and updates `left`.
void BroadPart::mend(std::span<LightGaussian* const> own, Eigen::MatrixXd& left) const {
  const auto count = static_cast<Eigen::Index>(own.size());
  Eigen::MatrixXd density(count, kPoints);
  for (Eigen::Index i = 0; i < count; ++i) density.row(i) = density_at(*own[static_cast<size_t>(i)], points_);
  const Eigen::MatrixXd beyond = density - (density * solve_.transpose()) * values_;
  Eigen::MatrixXd gram = beyond * beyond.transpose();
  gram.diagonal() += kStay * density.rowwise().squaredNorm();
  const Eigen::MatrixXd change = gram.ldlt().solve(beyond * left);
  for (Eigen::Index i = 0; i < count; ++i) {
    own[static_cast<size_t>(i)]->color += Vec3d(change(i, 0), change(i, 1), change(i, 2));
  }
  left -= density.transpose() * change;
}

}  // namespace velour

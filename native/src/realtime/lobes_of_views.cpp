#include "realtime/lobes_of_views.h"

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

namespace {

/// f of the chosen lobes.
Vec3d sum_of(const std::vector<WarpedLobe>& lobes, const std::vector<bool>& chosen, const Vec3d& wl, const Vec3d& wv) {
  Vec3d sum(0.0);
  for (size_t j = 0; j < lobes.size(); ++j) {
    if (chosen[j]) sum += lobes[j].coefficient * warped_kernel(lobes[j], wl, wv);
  }
  return sum;
}

class ParametricLobes : public LobesOfViews {
 public:
  explicit ParametricLobes(const ParametricBrdf& brdf) : brdf_(brdf) {}

  LobeOf of() const override { return LobeOf::f; }
  std::vector<ReachedLobe> lobes(const Vec3d& wv) const override {
    std::vector<ReachedLobe> lobes;
    for (const WarpedLobe& lobe : lobes_at(brdf_, wv)) lobes.push_back(reached(lobe, wv));
    return lobes;
  }
  Vec3d growth(const std::vector<ReachedLobe>& /*lobes*/, size_t /*j*/, const Vec3d& /*wl*/,
               const Vec3d& /*wv*/) const override {
    return Vec3d(1.0);
  }
  Vec3d soft_value(const std::vector<bool>& soft, const Vec3d& wl, const Vec3d& wv) const override {
    return sum_of(lobes_at(brdf_, wv), soft, wl, wv);
  }

 protected:
  const ParametricBrdf& brdf_;
};

class SymmetricLobes final : public ParametricLobes {
 public:
  explicit SymmetricLobes(const ParametricBrdf& brdf) : ParametricLobes(brdf), exchanged_(brdf) {}

  std::vector<ReachedLobe> lobes(const Vec3d& wv) const override {
    auto lobes = ParametricLobes::lobes(wv);
    for (ReachedLobe& lobe : lobes) lobe.lobe.coefficient *= 0.5;
    for (int j = 0; j < brdf_.lobe_count(); ++j) lobes.push_back(exchanged_.at(j, wv).value_or(ReachedLobe()));
    return lobes;
  }
  Vec3d growth(const std::vector<ReachedLobe>& lobes, size_t j, const Vec3d& wl, const Vec3d& wv) const override {
    if (j < own() || !lobes[j].reach.is_seen) return Vec3d(1.0);
    return Vec3d(exchanged_.growth(static_cast<int>(j - own()), lobes[j], wl, wv));
  }
  Vec3d soft_value(const std::vector<bool>& soft, const Vec3d& wl, const Vec3d& wv) const override {
    Vec3d sum = 0.5 * ParametricLobes::soft_value(soft, wl, wv);
    for (int j = 0; j < brdf_.lobe_count(); ++j) {
      if (soft[own() + static_cast<size_t>(j)]) sum += exchanged_.value(j, wl, wv);
    }
    return sum;
  }

 private:
  size_t own() const { return brdf_.space.size(); }

  ExchangedLobes exchanged_;
};

class HighlightLobes final : public LobesOfViews {
 public:
  explicit HighlightLobes(const PrincipledParameters& parameters) : ggx_(parameters) {}

  LobeOf of() const override { return LobeOf::f_cosine; }
  std::vector<ReachedLobe> lobes(const Vec3d& wv) const override {
    std::vector<ReachedLobe> lobes;
    for (const WarpedLobe& lobe : ggx_.lobes(wv)) lobes.push_back(reached(lobe, wv));
    return lobes;
  }
  Vec3d growth(const std::vector<ReachedLobe>& /*lobes*/, size_t /*j*/, const Vec3d& wl,
               const Vec3d& wv) const override {
    return wl.z > 0 ? ggx_.growth(wl, wv) : Vec3d(1.0);
  }
  Vec3d soft_value(const std::vector<bool>& soft, const Vec3d& wl, const Vec3d& wv) const override {
    if (std::find(soft.begin(), soft.end(), false) == soft.end()) return ggx_.f(wl, wv);
    return ggx_.base(wl, wv) + ggx_.growth(wl, wv) * sum_of(ggx_.lobes(wv), soft, wl, wv) / wl.z;
  }

 private:
  GgxLobes ggx_;
};

}  // namespace

std::unique_ptr<LobesOfViews> lobes_of_views(const ParametricBrdf& brdf) {
  if (brdf.symmetric) return std::make_unique<SymmetricLobes>(brdf);
  return std::make_unique<ParametricLobes>(brdf);
}

std::unique_ptr<LobesOfViews> lobes_of_views(const PrincipledParameters& parameters) {
  return std::make_unique<HighlightLobes>(parameters);
}

namespace {

constexpr double kSharpness[GgxLobes::kLobes] = {0.0127, 0.0885, 0.5195, 2.2067};
constexpr double kWeight[GgxLobes::kLobes] = {0.0003, 0.0132, 0.2604, 0.7058};

PrincipledParameters base_of(PrincipledParameters p) {
  p.part = PrincipledPart::base;
  return p;
}

Vec3d value(const Material& material, const Vec3d& wl, const Vec3d& wv) {
  ScratchArena arena;
  return Vec3d(material.prepare(Vec3(wv), arena)->eval_one(Vec3(wl)).f);
}

Vec3 view_at(double cosine) { return Vec3(Vec3d(std::sqrt(std::max(1 - cosine * cosine, 0.0)), 0, cosine)); }

double tangent_squared(double cosine) { return 1 / std::max(cosine * cosine, 1e-6) - 1; }

}  // namespace

GgxLobes::GgxLobes(const PrincipledParameters& p)
    : parameters_(p),
      alpha_(std::max(static_cast<double>(p.roughness * p.roughness), 0.01)),
      whole_(p),
      base_(base_of(p)) {}

std::vector<WarpedLobe> GgxLobes::lobes(const Vec3d& wv) const {
  const double cosine = std::max(wv.z, 0.02), square = alpha_ * alpha_;
  const Vec3d reflectance(PrincipledPoint(parameters_, view_at(cosine)).reflectance(static_cast<float>(cosine)));
  std::vector<WarpedLobe> lobes;
  for (int i = 0; i < kLobes; ++i) {
    WarpedLobe lobe;
    lobe.space = LobeSpace::half;
    lobe.bandwidth = 2 * kSharpness[i] / square;
    lobe.coefficient = kWeight[i] * masking(cosine, cosine) / (4 * kPiD * square * cosine) * reflectance;
    lobes.push_back(lobe);
  }
  return lobes;
}

Vec3d GgxLobes::growth(const Vec3d& wl, const Vec3d& wv) const {
  const double cosine = std::max(wv.z, 0.02);
  const PrincipledPoint point(parameters_, view_at(cosine));
  const auto at_facet = static_cast<float>(std::clamp(glm::dot(wl, glm::normalize(wl + wv)), 0.0, 1.0));
  // Without reflectance at normal incidence the ratio is 0, like the lobes.
  return masking(wl.z, cosine) / masking(cosine, cosine) * Vec3d(point.reflectance(at_facet)) /
         glm::max(Vec3d(point.reflectance(static_cast<float>(cosine))), Vec3d(1e-9));
}

Vec3d GgxLobes::base(const Vec3d& wl, const Vec3d& wv) const { return value(base_, wl, wv); }

Vec3d GgxLobes::f(const Vec3d& wl, const Vec3d& wv) const { return value(whole_, wl, wv); }

double GgxLobes::masking(double first, double second) const {
  const auto lambda = [&](double cosine) { return (std::sqrt(1 + alpha_ * alpha_ * tangent_squared(cosine)) - 1) / 2; };
  if (parameters_.lobe == GgxLobe::separable) return 1 / ((1 + lambda(first)) * (1 + lambda(second)));
  return 1 / (1 + lambda(first) + lambda(second));
}

}  // namespace velour

#include "brdf/measure/microfacet_trend.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Core>
#include <limits>

#include "math/optimize/nnls.h"

namespace velour {
namespace {

using Index = Eigen::Index;

struct Profile {
  float tail, power;
};
constexpr float kLargeTail = 40.0f;
constexpr Profile kProfiles[] = {{1.5f, 1.0f},       {2.0f, 1.0f},       {3.0f, 1.0f},      {6.0f, 1.0f},
                                 {kLargeTail, 1.0f}, {kLargeTail, 2.0f}, {kLargeTail, 4.0f}};
constexpr double kMinLogAlpha = -5.5, kMaxLogAlpha = 0.0, kStep = 0.2, kLastStep = 0.001;
constexpr int kRounds = 2;             // of searches for each of two lobes in turn, near where they are
constexpr double kLogAperture = -3.5;  // of the broadest flat top: 1.7 degrees
constexpr double kNear = 0.6;          // in log alpha
constexpr size_t kMaxSamples = 2000;   // that are read; of more, every nth
constexpr double kFloor = 1e-3;        // of f cos, relative to its mean: hardly distinguishable from 0
constexpr double kNegligible = 4e-6;   // of the mean squared difference, relative to f cos: 0.4 % of f
constexpr int kUnknowns = 2 + 6;       // of a lobe: its shape, and two colors
constexpr double kColorRidge = 1e-9;

/// What the lobes need of a pair.
struct Geometry {
  double cos_l, cos_v, cos_h_sq, tan_h_sq;
  double schlick;

  Geometry(const Vec3& wl, const Vec3& wv) : cos_l(wl.z), cos_v(wv.z) {
    const Vec3d h = glm::normalize(Vec3d(wl) + Vec3d(wv));
    cos_h_sq = h.z * h.z;
    tan_h_sq = std::max(1 - cos_h_sq, 0.0) / cos_h_sq;
    const double rest = 1 - std::min(glm::dot(Vec3d(wv), h), 1.0);
    schlick = rest * rest * rest * rest * rest;
  }

  double lobe(const MicrofacetShape& shape) const {
    const double a = static_cast<double>(shape.alpha) * static_cast<double>(shape.alpha);
    const double tail = static_cast<double>(shape.tail);
    const double x = tan_h_sq / a;
    const double log_d =
        shape.power > 1 ? -std::pow(x, static_cast<double>(shape.power)) : -tail * std::log1p(x / (tail - 1));
    const double d = std::exp(log_d) / (kPiD * a * cos_h_sq * cos_h_sq);
    const auto smith = [&](double cosine) { return std::sqrt(a + (1 - a) * cosine * cosine); };
    return 0.5 * d / (cos_v * smith(cos_l) + cos_l * smith(cos_v));
  }
};

/// The least squares for given shapes. Columns of a sample: diffuse, then normal and grazing of each lobe, times cos.
class Fit {
 public:
  explicit Fit(std::span<const IrregularSample> samples) {
    const size_t step = (samples.size() + kMaxSamples - 1) / kMaxSamples;
    for (size_t i = 0; i < samples.size(); i += step) geometry_.emplace_back(samples[i].wl, samples[i].wv);
    const auto count = static_cast<Index>(geometry_.size());
    cosine_.resize(count);
    for (auto& values : value_) values.resize(count);
    double mean = 0;
    for (Index i = 0; i < count; ++i) {
      const Rgb& f = samples[static_cast<size_t>(i) * step].f;
      const Geometry& at = geometry_[static_cast<size_t>(i)];
      cosine_[i] = 0.5 * (at.cos_l + at.cos_v);
      for (int c = 0; c < 3; ++c) {
        value_[c][i] = std::max(static_cast<double>(f[c]), 0.0) * cosine_[i];
        mean += kLuminance[c] * value_[c][i] / static_cast<double>(count);
      }
    }
    floor_ = kFloor * mean;
    negligible_ = kNegligible * values() * mean;
    for (int c = 0; c < 3; ++c) {
      root_[c] = (value_[c] + floor_).sqrt();
      weight_[c] = (value_[c] + floor_).inverse();  // of the linear fit: the squared slope of the root
    }
  }

  bool black() const { return !(floor_ > 0); }
  double values() const { return 3.0 * static_cast<double>(geometry_.size()); }

  /// Sets the colors [column x channel]; returns the sum of squared differences of the roots, and what is negligible.
  double solve(std::span<const MicrofacetShape> shapes, Eigen::MatrixXd& color) const {
    Eigen::ArrayXXd basis(cosine_.size(), static_cast<Index>(1 + 2 * shapes.size()));
    basis.col(0) = cosine_ / kPiD;
    for (size_t j = 0; j < shapes.size(); ++j) {
      const auto column = static_cast<Index>(1 + 2 * j);
      for (Index i = 0; i < cosine_.size(); ++i) {
        const Geometry& at = geometry_[static_cast<size_t>(i)];
        const double lobe = cosine_[i] * at.lobe(shapes[j]);
        basis(i, column) = (1 - at.schlick) * lobe;
        basis(i, column + 1) = at.schlick * lobe;
      }
    }
    color.resize(basis.cols(), 3);
    double cost = negligible_;
    for (int c = 0; c < 3; ++c) {
      const Eigen::MatrixXd weighted = basis.colwise() * weight_[c];
      Eigen::VectorXd x = Eigen::VectorXd::Ones(basis.cols());
      solve_nnls(basis.matrix().transpose() * weighted, weighted.transpose() * value_[c].matrix(), kColorRidge, x);
      color.col(c) = x;
      cost += (((basis.matrix() * x).array() + floor_).sqrt() - root_[c]).square().sum();
    }
    return cost;
  }

  /// Searches the shape of lobe `which` for log alpha in [least, most]; returns the cost.
  double search(std::vector<MicrofacetShape>& shapes, size_t which, double least, double most) const {
    Eigen::MatrixXd color;
    double lowest = std::numeric_limits<double>::infinity();
    MicrofacetShape best = shapes[which];
    for (const Profile& profile : kProfiles) {
      double at = least, cost = std::numeric_limits<double>::infinity();
      const auto consider = [&](double log_alpha) {
        shapes[which] = {static_cast<float>(std::exp(log_alpha)), profile.tail, profile.power};
        const double found = solve(shapes, color);
        if (found < cost) cost = found, at = log_alpha;
      };
      const double last = profile.power > 1 ? std::min(most, kLogAperture) : most;
      for (double x = least; x <= last; x += kStep) consider(x);
      for (double step = kStep / 2; step > kLastStep; step /= 2) {
        const double middle = at;
        for (const double x : {middle - step, middle + step})
          consider(std::clamp(x, kMinLogAlpha, std::max(last, kMinLogAlpha)));
      }
      if (cost < lowest) lowest = cost, best = {static_cast<float>(std::exp(at)), profile.tail, profile.power};
    }
    shapes[which] = best;
    return lowest;
  }

  double search_all(std::vector<MicrofacetShape>& shapes, size_t which) const {
    return search(shapes, which, kMinLogAlpha, kMaxLogAlpha);
  }
  double search_near(std::vector<MicrofacetShape>& shapes, size_t which) const {
    const double at = std::log(static_cast<double>(shapes[which].alpha));
    return search(shapes, which, std::max(at - kNear, kMinLogAlpha), std::min(at + kNear, kMaxLogAlpha));
  }

 private:
  std::vector<Geometry> geometry_;
  Eigen::ArrayXd cosine_;
  Eigen::ArrayXd value_[3], root_[3], weight_[3];
  double floor_ = 0, negligible_ = 0;
};

}  // namespace

MicrofacetTrend::MicrofacetTrend(std::span<const IrregularSample> samples, size_t lobes) {
  if (samples.empty()) return;
  const Fit fit(samples);
  if (fit.black()) return;
  Eigen::MatrixXd color;
  double cost = fit.solve(shapes_, color);
  while (shapes_.size() < std::min(lobes, kMaxLobes)) {
    auto with = shapes_;
    with.push_back({.alpha = 0.1f, .tail = 2.0f});
    double lower = fit.search_all(with, with.size() - 1);
    for (int round = 0; with.size() > 1 && round < kRounds; ++round) {
      for (size_t j = 0; j < with.size(); ++j) lower = fit.search_near(with, j);
    }
    // Bayesian information criterion.
    if (!(fit.values() * std::log(cost / lower) > kUnknowns * std::log(fit.values()))) break;
    shapes_ = with;
    cost = lower;
  }
  fit.solve(shapes_, color);
  const auto rgb = [&](Index row) { return Rgb(color(row, 0), color(row, 1), color(row, 2)); };
  diffuse_ = rgb(0);
  for (size_t j = 0; j < shapes_.size(); ++j) {
    normal_[j] = rgb(static_cast<Index>(1 + 2 * j));
    grazing_[j] = rgb(static_cast<Index>(2 + 2 * j));
  }
}

Rgb MicrofacetTrend::f(const Vec3& wl, const Vec3& wv) const {
  const Geometry at(wl, wv);
  Vec3d sum = Vec3d(diffuse_) / kPiD;
  for (size_t j = 0; j < shapes_.size(); ++j) {
    sum += at.lobe(shapes_[j]) * ((1 - at.schlick) * Vec3d(normal_[j]) + at.schlick * Vec3d(grazing_[j]));
  }
  return Rgb(sum);
}

}  // namespace velour

#include "realtime/broad_part.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>

#include "sphere/directions.h"
#include "srbf/kernel.h"

namespace velour {
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

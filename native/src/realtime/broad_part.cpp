#include "realtime/broad_part.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>

#include "sphere/directions.h"
#include "srbf/kernel.h"

namespace velour {
namespace {

constexpr int kPoints = 1500;               // of the sphere
constexpr double kBandwidth = 14;           // deviation 15 degrees
constexpr double kApart = 25 * kPiD / 180;  // of rings, and of the Gaussians of one
constexpr double kRidge = 1e-5;             // of the Gram matrix' mean diagonal: weights stay small

std::vector<LightGaussian> rings() {
  std::vector<LightGaussian> gaussians;
  constexpr int kCounts[] = {1, 6, 12, 18};
  for (int ring = 0; ring < 4; ++ring) {
    const double theta = ring * kApart;
    for (int i = 0; i < kCounts[ring]; ++i) {
      const double phi = 2 * kPiD * i / kCounts[ring];
      const Vec3d center(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      gaussians.push_back({.center = center, .bandwidth = kBandwidth, .color = Vec3d(1.0)});
    }
  }
  return gaussians;
}

}  // namespace

BroadPart::BroadPart() : gaussians_(rings()) {
  for (const Vec3& w : sphere_fibonacci(kPoints)) points_.emplace_back(w);
  Eigen::MatrixXd values(kLobes, kPoints);
  for (int p = 0; p < kPoints; ++p) {
    const Vec3d& w = points_[static_cast<size_t>(p)];
    values(0, p) = std::max(w.z, 0.0) / kPiD;
    for (int g = 0; g < kGaussians; ++g) {
      values(g + 1, p) = value_of(std::span(&gaussians_[static_cast<size_t>(g)], 1), w).x;
    }
  }
  Eigen::MatrixXd gram = values * values.transpose();
  gram.diagonal().array() += kRidge * gram.trace() / kLobes;
  solve_ = gram.ldlt().solve(values);
}

BroadPart::Fitted BroadPart::fitted(const std::function<Vec3d(const Vec3d&)>& slice) const {
  Eigen::MatrixXd values(kPoints, 3);
  for (int p = 0; p < kPoints; ++p) {
    const Vec3d value = slice(points_[static_cast<size_t>(p)]);
    for (int c = 0; c < 3; ++c) values(p, c) = value[c];
  }
  const Eigen::MatrixXd weights = solve_ * values;
  const auto color = [&](int i) { return Vec3d(weights(i, 0), weights(i, 1), weights(i, 2)); };
  Fitted fitted{.cosine = color(0), .gaussians = gaussians_};
  for (int g = 0; g < kGaussians; ++g) fitted.gaussians[static_cast<size_t>(g)].color = color(g + 1);
  return fitted;
}

}  // namespace velour

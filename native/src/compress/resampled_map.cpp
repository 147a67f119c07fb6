#include "compress/resampled_map.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>

namespace velour {
namespace {

constexpr uint32_t kSamples = 8;  // a place of the finer grid

/// At each sample of a period, what interpolation between `places` makes of each.
Eigen::MatrixXd interpolation(uint32_t places, uint32_t samples) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(samples, places);
  for (uint32_t s = 0; s < samples; ++s) {
    const double at = (s + 0.5) / samples * places - 0.5, low = std::floor(at);
    const auto left = static_cast<uint32_t>(low + places) % places;
    out(s, left) += 1 - (at - low);
    out(s, (left + 1) % places) += at - low;
  }
  return out;
}

/// Averages over `width` samples from each on.
Eigen::MatrixXd averaged(const Eigen::MatrixXd& samples, Eigen::Index width) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(samples.rows(), samples.cols());
  for (Eigen::Index s = 0; s < samples.rows(); ++s) {
    for (Eigen::Index i = 0; i < width; ++i) out.row(s) += samples.row((s + i) % samples.rows());
  }
  return out / static_cast<double>(width);
}

}  // namespace

Eigen::MatrixXf resampling(uint32_t from, uint32_t to, double window) {
  const uint32_t samples = from * kSamples;
  const auto width = static_cast<Eigen::Index>(std::clamp(std::lround(window * samples), 1L, long{samples} / to));
  const Eigen::MatrixXd coarse = averaged(interpolation(to, samples), width);
  const Eigen::MatrixXd fine = averaged(interpolation(from, samples), width);
  const Eigen::MatrixXd solved = (coarse.transpose() * coarse).ldlt().solve(coarse.transpose() * fine);
  return solved.cast<float>();
}

std::vector<HalfBits> resampled(const std::vector<HalfBits>& map, size_t values, const Eigen::MatrixXf& x,
                                const Eigen::MatrixXf& y) {
  const auto width = x.cols(), height = y.cols();
  const auto row = static_cast<Eigen::Index>(values);
  Eigen::MatrixXf from(row, width * height), across(row, x.rows() * height), out(row, x.rows() * y.rows());
  halves_to_floats(map, {from.data(), map.size()});
  for (Eigen::Index r = 0; r < height; ++r) {
    across.middleCols(r * x.rows(), x.rows()) = from.middleCols(r * width, width) * x.transpose();
  }
  out.setZero();
  for (Eigen::Index to = 0; to < y.rows(); ++to) {
    for (Eigen::Index r = 0; r < height; ++r) {
      out.middleCols(to * x.rows(), x.rows()) += y(to, r) * across.middleCols(r * x.rows(), x.rows());
    }
  }
  std::vector<HalfBits> halves(static_cast<size_t>(out.size()));
  floats_to_halves({out.data(), halves.size()}, halves);
  return halves;
}

}  // namespace velour

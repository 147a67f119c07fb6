#include <tbb/parallel_for.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include "scene/equirectangular.h"
#include "scene/sky_kernels.h"
#include "scene/sky_mixture.h"
#include "sphere/directions.h"
#include "srbf/kernel.h"

namespace velour {
namespace {

constexpr int kStepsARound = 4, kLastSteps = 12;
constexpr size_t kTestDirections = 1500;
constexpr size_t kBlocksAPiece = 16;  // blocks per task; fixed, so that sums do not depend on the number of threads

struct Moved {
  Vec3d center;
  double bandwidth;
};

/// Center and bandwidth of a lobe from moments about `from`, divided by their weight.
Moved moved(const Vec3d& from, const Vec3d& d, double q) {
  // |from + d|^2, shortened by the spread, is 1 - 2 q + |d|^2.
  const double lost = std::clamp(2 * q - glm::dot(d, d), 0.0, 1.0);
  const Vec3d mean = from + d;
  const double length = glm::length(mean);
  return {length > 1e-9 ? mean / length : from, gaussian_bandwidth_of_mean(lost / (1 + std::sqrt(1 - lost)))};
}

class SkyFit {
 public:
  SkyFit(const EquirectangularImage& image, const SkyFitOptions& options, const Progress& progress)
      : options_(options),
        progress_(progress),
        points_(sky_points(image)),
        scale_(4 * kPiD * static_cast<double>(image.mean_luminance())),
        tests_(sphere_fibonacci(static_cast<int>(kTestDirections))) {
    smooth_image();
  }

  SkyMixture run() {
    push(Vec3d(0, 0, 1), kMinMeanBandwidth, 1.0);
    for (;;) {
      for (int i = 0; i < kStepsARound; ++i) step();
      error_ = error();
      if (error_ <= options_.tolerance || static_cast<int>(lobes_.size()) >= options_.max_lobes) break;
      if (!give_birth()) break;
    }
    for (int i = 0; i < kLastSteps; ++i) step();
    error_ = error();
    return result();
  }

 private:
  void push(const Vec3d& center, double bandwidth, double share) {
    const Vec3 c(center);
    lobes_.x.push_back(c.x);
    lobes_.y.push_back(c.y);
    lobes_.z.push_back(c.z);
    lobes_.bandwidth.push_back(static_cast<float>(bandwidth));
    lobes_.share.push_back(static_cast<float>(share));
    lobes_.peak.push_back(static_cast<float>(share / kernel_integral(Kernel::gaussian, bandwidth)));
  }

  Vec3d center(size_t k) const { return glm::normalize(Vec3d(lobes_.x[k], lobes_.y[k], lobes_.z[k])); }

  /// Expectation step: sums the moments over all cells, in the order of the cells.
  void expect() {
    progress_.check();
    const size_t n = lobes_.size(), blocks = (points_.size() + kSkyBlock - 1) / kSkyBlock;
    const size_t pieces = (blocks + kBlocksAPiece - 1) / kBlocksAPiece;
    pieces_.assign(pieces * n, {});
    tbb::parallel_for(size_t{0}, pieces, [&](size_t piece) {
      std::vector<float> scratch(n * kSkyBlock);
      const size_t end = std::min(blocks, (piece + 1) * kBlocksAPiece);
      for (size_t block = piece * kBlocksAPiece; block < end; ++block) {
        add_sky_block(points_, block * kSkyBlock, lobes_, scratch.data(), &pieces_[piece * n]);
      }
    });
    moments_.assign(n, {});
    for (size_t i = 0; i < pieces_.size(); ++i) moments_[i % n] += pieces_[i];
  }

  /// One step of expectation maximization. Drops lobes that have lost their energy.
  void step() {
    expect();
    const SkyLobes old = std::move(lobes_);
    lobes_ = {};
    for (size_t k = 0; k < old.size(); ++k) {
      const SkyMoments& m = moments_[k];
      if (!(m.energy > 1e-7)) continue;
      const Vec3d from = glm::normalize(Vec3d(old.x[k], old.y[k], old.z[k]));
      const Moved to = moved(from, Vec3d(m.dx, m.dy, m.dz) / m.energy, m.q / m.energy);
      push(to.center, to.bandwidth, m.energy);
    }
  }

  /// Each of the worst lobes spawns a lobe at the image's excess within it. Returns false if there is no excess.
  bool give_birth() {
    expect();
    std::vector<size_t> order(lobes_.size());
    std::iota(order.begin(), order.end(), size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return moments_[a].chi > moments_[b].chi; });
    const size_t room = static_cast<size_t>(options_.max_lobes) - lobes_.size();
    const size_t births = std::min(room, (lobes_.size() + 1) / 2);
    bool any = false;
    for (size_t i = 0; i < births; ++i) any |= divide(order[i]);
    return any;
  }

  bool divide(size_t k) {
    const SkyMoments& m = moments_[k];
    const double share = std::min(m.excess, 0.5 * m.energy);
    if (!(m.chi > 0) || !(share > 1e-6)) return false;
    const Moved child = moved(center(k), Vec3d(m.chi_x, m.chi_y, m.chi_z) / m.chi, m.chi_q / m.chi);
    push(child.center, std::max(child.bandwidth, static_cast<double>(lobes_.bandwidth[k])), share);
    lobes_.share[k] -= static_cast<float>(share);
    lobes_.peak[k] *= static_cast<float>(1 - share / m.energy);
    return true;
  }

  void smooth_image() {
    smoothed_.resize(tests_.size());
    tbb::parallel_for(size_t{0}, tests_.size(), [&](size_t i) {
      smoothed_[i] = smoothed_sky(points_, tests_[i], static_cast<float>(SkyMixture::kSmoothing));
    });
  }

  double error() const {
    std::vector<double> difference(tests_.size());
    tbb::parallel_for(size_t{0}, tests_.size(), [&](size_t i) {
      double value = 0;
      for (size_t k = 0; k < lobes_.size(); ++k) {
        value += static_cast<double>(lobes_.peak[k]) * kernel_convolution(Kernel::gaussian, Vec3d(tests_[i]),
                                                                          SkyMixture::kSmoothing, center(k),
                                                                          static_cast<double>(lobes_.bandwidth[k]));
      }
      difference[i] = value - smoothed_[i];
    });
    const auto norm_sq = [](const std::vector<double>& v) {
      return std::inner_product(v.begin(), v.end(), v.begin(), 0.0);
    };
    return std::sqrt(norm_sq(difference) / norm_sq(smoothed_));
  }

  SkyMixture result() {
    expect();  // colors from the responsibilities of the final lobes
    SkyMixture sky;
    for (size_t k = 0; k < lobes_.size(); ++k) {
      const SkyMoments& m = moments_[k];
      const double peak = scale_ / kernel_integral(Kernel::gaussian, static_cast<double>(lobes_.bandwidth[k]));
      sky.center.push_back(Vec3(center(k)));
      sky.bandwidth.push_back(lobes_.bandwidth[k]);
      sky.coefficient.push_back(Rgb(peak * Vec3d(m.r, m.g, m.b)));
    }
    sky.relative_l2 = static_cast<float>(error_);
    return sky;
  }

  const SkyFitOptions options_;
  const Progress& progress_;
  const SkyPoints points_;
  const double scale_;  // luminance x solid angle of the whole image
  const std::vector<Vec3> tests_;
  std::vector<double> smoothed_;
  SkyLobes lobes_;
  std::vector<SkyMoments> pieces_, moments_;
  double error_ = 0;
};

}  // namespace

SkyMixture fit_sky(const EquirectangularImage& image, const SkyFitOptions& options, const Progress& progress) {
  if (!(image.mean_luminance() > 0.0f)) return {};
  const auto start = std::chrono::steady_clock::now();
  SkyMixture sky = SkyFit(image, options, progress).run();
  sky.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return sky;
}

}  // namespace velour

#include "light/environment_fit.h"

#include <tbb/parallel_for.h>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include "light/environment_mixture.h"
#include "light/equirectangular.h"
#include "math/sphere/directions.h"
#include "math/srbf/kernel.h"

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

class EnvironmentFit {
 public:
  EnvironmentFit(const EquirectangularImage& image, const EnvironmentFitOptions& options, const Progress& progress)
      : options_(options),
        progress_(progress),
        points_(environment_points(image)),
        scale_(points_.total),
        tests_(sphere_fibonacci(static_cast<int>(kTestDirections))) {
    smooth_image();
  }

  EnvironmentMixture run() {
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
    const size_t n = lobes_.size(), blocks = (points_.size() + kEnvironmentBlock - 1) / kEnvironmentBlock;
    const size_t pieces = (blocks + kBlocksAPiece - 1) / kBlocksAPiece;
    pieces_.assign(pieces * n, {});
    tbb::parallel_for(size_t{0}, pieces, [&](size_t piece) {
      std::vector<float> scratch(n * kEnvironmentBlock);
      const size_t end = std::min(blocks, (piece + 1) * kBlocksAPiece);
      for (size_t block = piece * kBlocksAPiece; block < end; ++block) {
        add_environment_block(points_, block * kEnvironmentBlock, lobes_, scratch.data(), &pieces_[piece * n]);
      }
    });
    moments_.assign(n, {});
    for (size_t i = 0; i < pieces_.size(); ++i) moments_[i % n] += pieces_[i];
  }

  /// One step of expectation maximization. Drops lobes that have lost their energy.
  void step() {
    expect();
    const EnvironmentLobes old = std::move(lobes_);
    lobes_ = {};
    for (size_t k = 0; k < old.size(); ++k) {
      const EnvironmentMoments& m = moments_[k];
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
    const EnvironmentMoments& m = moments_[k];
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
      smoothed_[i] = smoothed_environment(points_, tests_[i], static_cast<float>(EnvironmentMixture::kSmoothing));
    });
  }

  double error() const {
    std::vector<double> difference(tests_.size());
    tbb::parallel_for(size_t{0}, tests_.size(), [&](size_t i) {
      double value = 0;
      for (size_t k = 0; k < lobes_.size(); ++k) {
        value += static_cast<double>(lobes_.peak[k]) * kernel_convolution(Kernel::gaussian, Vec3d(tests_[i]),
                                                                          EnvironmentMixture::kSmoothing, center(k),
                                                                          static_cast<double>(lobes_.bandwidth[k]));
      }
      difference[i] = value - smoothed_[i];
    });
    const auto norm_sq = [](const std::vector<double>& v) {
      return std::inner_product(v.begin(), v.end(), v.begin(), 0.0);
    };
    return std::sqrt(norm_sq(difference) / norm_sq(smoothed_));
  }

  EnvironmentMixture result() {
    expect();  // colors from the responsibilities of the final lobes
    EnvironmentMixture sky;
    for (size_t k = 0; k < lobes_.size(); ++k) {
      const EnvironmentMoments& m = moments_[k];
      const double peak = scale_ / kernel_integral(Kernel::gaussian, static_cast<double>(lobes_.bandwidth[k]));
      sky.center.push_back(Vec3(center(k)));
      sky.bandwidth.push_back(lobes_.bandwidth[k]);
      sky.coefficient.push_back(Rgb(peak * Vec3d(m.r, m.g, m.b)));
    }
    sky.relative_l2 = static_cast<float>(error_);
    return sky;
  }

  const EnvironmentFitOptions options_;
  const Progress& progress_;
  const EnvironmentPoints points_;
  const double scale_;  // luminance x solid angle of the whole image
  const std::vector<Vec3> tests_;
  std::vector<double> smoothed_;
  EnvironmentLobes lobes_;
  std::vector<EnvironmentMoments> pieces_, moments_;
  double error_ = 0;
};

}  // namespace

namespace {

/// Texels of fewer are too wide to stand for a direction each.
constexpr int kMinWidth = 64, kMinHeight = 32;

/// The bilinear interpolation of a small image at more texels.
EquirectangularImage upsampled(const EquirectangularImage& image) {
  const int width = std::max(image.width(), kMinWidth), height = std::max(image.height(), kMinHeight);
  std::vector<float> rgb;
  for (int y = 0; y < height; ++y) {
    for (int first = 0; first < width; first += DirectionBatch::kCapacity) {
      DirectionBatch world;
      for (int x = first; x < std::min(width, first + DirectionBatch::kCapacity); ++x) {
        const double phi = 2 * kPiD * (0.5 - (x + 0.5) / width);
        world.push(direction(static_cast<float>(kPiD * (y + 0.5) / height), static_cast<float>(phi)));
      }
      world.pad();
      RgbBatch radiance;
      ScalarBatch pdf;
      image.look_up({1, Mat3(1.0f)}, world, radiance, pdf);
      for (int i = 0; i < world.count; ++i) {
        const Rgb c = radiance.get(i);
        rgb.insert(rgb.end(), {c.r, c.g, c.b});
      }
    }
  }
  return EquirectangularImage({width, height, 3, rgb});
}

}  // namespace

EnvironmentMixture fit_environment(const EquirectangularImage& image, const EnvironmentFitOptions& options,
                                   const Progress& progress) {
  if (!(image.mean_luminance() > 0.0f)) return {};
  if (image.width() < kMinWidth || image.height() < kMinHeight) {
    return fit_environment(upsampled(image), options, progress);
  }
  const auto start = std::chrono::steady_clock::now();
  EnvironmentMixture sky = EnvironmentFit(image, options, progress).run();
  sky.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return sky;
}

namespace {

constexpr double kMaxEnergy = 1.0 / 4096;
constexpr double kWidest = 3.0 * kPiD / 180;

/// A rectangle of texels.
struct Cell {
  int x0, y0, x1, y1;
  int width() const { return x1 - x0; }
  int height() const { return y1 - y0; }
};

class Gathering {
 public:
  explicit Gathering(const EquirectangularImage& image)
      : image_(image), columns_(static_cast<size_t>(image.width()) + 1) {
    sum_energy();
    // Azimuth of a column's center: Blender's u = 1/2 - phi / (2 pi).
    for (int x = 0; x < image.width(); ++x) {
      const double phi = 2 * kPiD * (0.5 - (x + 0.5) / image.width());
      cosine_.push_back(std::cos(phi));
      sine_.push_back(std::sin(phi));
    }
  }

  EnvironmentPoints run() {
    std::vector<Cell> open = {{0, 0, image_.width(), image_.height()}};
    while (!open.empty()) {
      const Cell cell = open.back();
      open.pop_back();
      if (!splits(cell)) {
        add(cell);
        continue;
      }
      const bool across = width(cell) >= height(cell) ? cell.width() > 1 : cell.height() <= 1;
      const int x = (cell.x0 + cell.x1) / 2, y = (cell.y0 + cell.y1) / 2;
      open.push_back(across ? Cell{x, cell.y0, cell.x1, cell.y1} : Cell{cell.x0, y, cell.x1, cell.y1});
      open.push_back(across ? Cell{cell.x0, cell.y0, x, cell.y1} : Cell{cell.x0, cell.y0, cell.x1, y});
    }
    points_.total = total_;
    return std::move(points_);
  }

 private:
  /// Summed-area table of luminance x solid angle.
  void sum_energy() {
    const int w = image_.width(), h = image_.height();
    sums_.assign(columns_ * (static_cast<size_t>(h) + 1), 0.0);
    for (int y = 0; y < h; ++y) {
      const EnvironmentTexel* row = image_.row(y) + 1;
      double along = 0;
      for (int x = 0; x < w; ++x) {
        along += solid_angle(y) * luminance_of(row[x]);
        sum_at(x + 1, y + 1) = sum_at(x + 1, y) + along;
      }
    }
    total_ = sum_at(w, h);
  }

  double& sum_at(int x, int y) { return sums_[static_cast<size_t>(y) * columns_ + static_cast<size_t>(x)]; }
  static double luminance_of(const EnvironmentTexel& t) { return static_cast<double>(luminance({t.r, t.g, t.b})); }
  double theta(double y) const { return kPiD * y / image_.height(); }
  double solid_angle(int y) const { return 2 * kPiD / image_.width() * (std::cos(theta(y)) - std::cos(theta(y + 1))); }
  double height(const Cell& c) const { return theta(c.height()); }
  double width(const Cell& c) const {
    return 2 * kPiD * c.width() / image_.width() * std::sin(theta(0.5 * (c.y0 + c.y1)));
  }

  bool splits(const Cell& c) {
    if (c.width() == 1 && c.height() == 1) return false;
    const double energy = sum_at(c.x1, c.y1) - sum_at(c.x0, c.y1) - sum_at(c.x1, c.y0) + sum_at(c.x0, c.y0);
    return energy > kMaxEnergy * total_ || std::max(width(c), height(c)) > kWidest;
  }

  /// Mean direction over the bilinear footprint of a texel of row `y`: horizontal length and z. That of the texel
  /// itself is exact; the footprint is the texel smeared by another texel.
  glm::dvec2 texel_mean(int y) const {
    const auto sinc = [](double x) { return std::sin(x) / x; };
    const double top = theta(y), bottom = theta(y + 1);
    const double sine =
        ((bottom - top) - (std::sin(2 * bottom) - std::sin(2 * top)) / 2) / 2 / (std::cos(top) - std::cos(bottom));
    const double across = sinc(kPiD / image_.width()), down = sinc(theta(0.5));
    return down * glm::dvec2(across * across * sine, (std::cos(top) + std::cos(bottom)) / 2);
  }

  void add(const Cell& cell) {
    Vec3d moment(0), plain(0), color(0);
    double energy = 0, area = 0;
    for (int y = cell.y0; y < cell.y1; ++y) {
      const EnvironmentTexel* row = image_.row(y) + 1;
      const double share = solid_angle(y);
      const glm::dvec2 mean = texel_mean(y);
      for (int x = cell.x0; x < cell.x1; ++x) {
        const auto at = static_cast<size_t>(x);
        const Vec3d w(mean.x * cosine_[at], mean.x * sine_[at], mean.y);
        const double e = share * luminance_of(row[x]);
        moment += e * w;
        plain += share * w;
        color += share * Vec3d(row[x].r, row[x].g, row[x].b);
        energy += e;
        area += share;
      }
    }
    push(energy > 0 ? moment / energy : plain / area, color / total_, energy / total_, area);
  }

  void push(const Vec3d& mean, const Vec3d& color, double energy, double area) {
    const double length = glm::length(mean);
    const Vec3 unit = length > 1e-9 ? Vec3(mean / length) : Vec3(0, 0, 1);  // of the whole sphere: none
    points_.x.push_back(unit.x);
    points_.y.push_back(unit.y);
    points_.z.push_back(unit.z);
    points_.spread.push_back(static_cast<float>(1 - length));
    points_.energy.push_back(static_cast<float>(energy));
    points_.solid_angle.push_back(static_cast<float>(area));
    points_.r.push_back(static_cast<float>(color.r));
    points_.g.push_back(static_cast<float>(color.g));
    points_.b.push_back(static_cast<float>(color.b));
  }

  const EquirectangularImage& image_;
  const size_t columns_;
  std::vector<double> sums_, cosine_, sine_;
  double total_ = 0;
  EnvironmentPoints points_;
};

}  // namespace

EnvironmentPoints environment_points(const EquirectangularImage& image) { return Gathering(image).run(); }

}  // namespace velour

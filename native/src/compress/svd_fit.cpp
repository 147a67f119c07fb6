#include "compress/svd_fit.h"

#include <algorithm>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <numeric>
#include <string>

#include "compress/brightening.h"
#include "compress/side_views.h"
#include "image/half_image.h"
#include "job/error.h"
#include "job/parallel.h"
#include "sphere/random.h"

namespace velour {
namespace {

constexpr int kPowerIterations = 2;
// Components of less energy, relative to the strongest, are rounding: their functions are not orthogonal to the others.
constexpr double kRounding = 1e-9;
constexpr int kOversampling = 8;                    // columns beyond those asked for
constexpr Eigen::Index kRows = 16, kColumns = 512;  // of a block of work: fixed, so that sums do not depend on threads

// What a small BTF gets where nobody asked for a size.
constexpr uint64_t kUsualRatio = 200, kUsualLeast = 8;

/// How many components fit.
uint64_t components_within(uint64_t asked, const BtfMeasurement& measurement) {
  const uint64_t one = (measurement.layout().pairs() + pyramid_texels(measurement.grid())) * sizeof(HalfBits);
  const uint64_t bytes = asked > 0 ? asked : std::max(measurement.raw_bytes() / kUsualRatio, kUsualLeast * one);
  const uint64_t count = std::min<uint64_t>(bytes / one, FactoredBtf::kMaxComponents);
  if (count > 0) return count;
  throw Error(Status::invalid_argument, "One component takes " + std::to_string(one) + " bytes, and " +
                                            std::to_string(bytes) + " were asked for; ask for more.");
}

template <class Work>
void for_blocks(Eigen::Index extent, Eigen::Index step, int threads, const Progress& progress, const Work& work) {
  parallel_pieces(static_cast<size_t>((extent + step - 1) / step), threads, progress, [&](size_t i) {
    const Eigen::Index first = static_cast<Eigen::Index>(i) * step;
    work(first, std::min(step, extent - first));
  });
}

/// One colour axis on its way to its components.
struct AxisSketch {
  RowMatrix basis;         // texel x column, orthonormal
  RowMatrix response;      // pair x column: the matrix times the basis
  RowMatrix image;         // texel x column: the transposed matrix times the response
  Eigen::VectorXd energy;  // of each component, falling
};

class SvdSolver {
 public:
  SvdSolver(const BtfMeasurement& measurement, const BtfFitOptions& options, Progress& progress)
      : measurement_(measurement),
        options_(options),
        progress_(progress),
        views_(measurement, options.companding, options.threads, progress) {}

  SvdFit solve(uint64_t components) {
    progress_.stage("colours", 0, 0.05);
    btf_.axes = views_.decorrelate();
    const auto columns = static_cast<Eigen::Index>(
        std::min({components + kOversampling, measurement_.layout().pairs(), measurement_.grid().texels()}));
    for (size_t a = 0; a < 3; ++a) start(sketch_[a], columns, a);
    for (int i = 0; i <= kPowerIterations; ++i) {
      progress_.stage("directions", 0.05 + 0.2 * i, 0.25 + 0.2 * i);
      pass(i < kPowerIterations);
    }
    for (AxisSketch& sketch : sketch_) rotate(sketch);
    choose(components);
    progress_.stage("texels", 0.65, 0.8);
    project();
    return {std::move(btf_), views_.not_finite()};
  }

 private:
  void start(AxisSketch& sketch, Eigen::Index columns, size_t axis) const {
    const auto texels = static_cast<Eigen::Index>(measurement_.grid().texels());
    sketch.basis.resize(texels, columns);
    for (Eigen::Index t = 0; t < texels; ++t) {
      RandomStream random(options_.seed, static_cast<uint64_t>(t), axis);
      // Sums of three uniform numbers are close enough to normal ones.
      for (Eigen::Index c = 0; c < columns; ++c) {
        const float u = random.next(), v = random.next();
        sketch.basis(t, c) = u + v + random.next() - 1.5f;
      }
    }
    sketch.response.resize(static_cast<Eigen::Index>(measurement_.layout().pairs()), columns);
    orthonormalise(sketch.basis);
  }

  static void orthonormalise(RowMatrix& m) {
    const Eigen::HouseholderQR<Eigen::MatrixXf> qr{Eigen::MatrixXf(m)};
    m = qr.householderQ() * Eigen::MatrixXf::Identity(m.rows(), m.cols());
  }

  /// The response of every view to the basis; when `onward`, also the image of it, which becomes the next basis.
  void pass(bool onward) {
    for (AxisSketch& s : sketch_) s.image.setZero(s.basis.rows(), onward ? s.basis.cols() : 0);
    for (uint32_t v = 0; v < views_.views(); ++v) {
      progress_.check();
      views_.read(v, f_);
      views_.planes(f_, measurement_.grid().texels(), planes_);
      for (size_t a = 0; a < 3; ++a) respond(sketch_[a], planes_[a], v, onward);
      progress_.update(static_cast<double>(v + 1) / views_.views());
    }
    if (!onward) return;
    for (AxisSketch& s : sketch_) {
      s.basis = s.image;
      orthonormalise(s.basis);
    }
  }

  void respond(AxisSketch& s, const RowMatrix& plane, uint32_t view, bool onward) const {
    const auto first = static_cast<Eigen::Index>(measurement_.layout().first(view));
    for_blocks(plane.rows(), kRows, options_.threads, progress_, [&](Eigen::Index row, Eigen::Index count) {
      s.response.middleRows(first + row, count).noalias() = plane.middleRows(row, count) * s.basis;
    });
    if (!onward) return;
    const auto response = s.response.middleRows(first, plane.rows());
    for_blocks(plane.cols(), kColumns, options_.threads, progress_, [&](Eigen::Index column, Eigen::Index count) {
      s.image.middleRows(column, count).noalias() += plane.middleCols(column, count).transpose() * response;
    });
  }

  /// Turns the response into orthonormal functions of the pair, the strongest first.
  static void rotate(AxisSketch& s) {
    const Eigen::MatrixXd response = s.response.cast<double>();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(response.transpose() * response);
    const Eigen::Index columns = response.cols();
    s.energy = solver.eigenvalues().reverse().cwiseMax(0.0);
    const Eigen::MatrixXd vectors = solver.eigenvectors().rowwise().reverse();
    Eigen::MatrixXd functions = response * vectors;
    for (Eigen::Index c = 0; c < columns; ++c) {
      const double norm = std::sqrt(s.energy[c]);
      functions.col(c) *= norm > 0 ? 1 / norm : 0;
    }
    s.response = functions.cast<float>();
  }

  /// The `components` of most energy of all axes.
  void choose(uint64_t components) {
    std::vector<std::pair<size_t, Eigen::Index>> all;  // axis, column
    for (size_t a = 0; a < 3; ++a) {
      for (Eigen::Index c = 0; c < sketch_[a].energy.size(); ++c) all.emplace_back(a, c);
    }
    const auto energy = [&](const auto& x) { return sketch_[x.first].energy[x.second]; };
    std::stable_sort(all.begin(), all.end(), [&](const auto& x, const auto& y) { return energy(x) > energy(y); });
    all.resize(std::min<size_t>(all.size(), components));
    const double least = kRounding * energy(all.front());
    all.erase(std::find_if(all.begin() + 1, all.end(), [&](const auto& x) { return energy(x) <= least; }), all.end());
    std::sort(all.begin(), all.end());
    function_.resize(sketch_[0].response.rows(), static_cast<Eigen::Index>(all.size()));
    for (const auto& [axis, column] : all) {
      function_.col(static_cast<Eigen::Index>(btf_.axis.size())) = sketch_[axis].response.col(column);
      btf_.axis.push_back(static_cast<uint8_t>(axis));
    }
    // What is stored is what the texels are projected on.
    btf_.pair_value.resize(static_cast<size_t>(function_.size()));
    const std::span<float> values(function_.data(), btf_.pair_value.size());
    floats_to_halves(values, btf_.pair_value);
    halves_to_floats(btf_.pair_value, values);
  }

  struct Level {
    uint32_t width, height;
    RowMatrix value;      // texel x component
    double measured = 0;  // sum of the squares of companded images, times both cosines
  };

  /// Coefficients of every level: products of the functions with the filtered measurement.
  void project() {
    std::vector<Level> levels;
    uint32_t width = measurement_.grid().width, height = measurement_.grid().height;
    for (;; width = half_of(width), height = half_of(height)) {
      levels.push_back({width, height, RowMatrix::Zero(Eigen::Index{width} * height, function_.cols())});
      if (width == 1 && height == 1) break;
    }
    for (uint32_t v = 0; v < views_.views(); ++v) {
      progress_.check();
      views_.read(v, f_);
      for (size_t l = 0; l < levels.size(); ++l) {
        if (l > 0) f_ = halved_images(f_, levels[l - 1].width, levels[l - 1].height);
        project(v, levels[l]);
      }
      progress_.update(static_cast<double>(v + 1) / views_.views());
    }
    for (Level& level : levels) {
      level.value *= brightening(options_.companding, level.measured, modelled(level.value));
      TexelLevel stored{level.width, level.height, std::vector<HalfBits>(static_cast<size_t>(level.value.size()))};
      floats_to_halves({level.value.data(), stored.value.size()}, stored.value);
      btf_.levels.push_back(std::move(stored));
    }
  }

  void project(uint32_t view, Level& level) {
    views_.planes(f_, static_cast<uint64_t>(level.value.rows()), planes_);
    const auto first = static_cast<Eigen::Index>(measurement_.layout().first(view));
    for (size_t a = 0; a < 3; ++a) {
      for (Eigen::Index light = 0; light < planes_[a].rows(); ++light) {
        level.measured += cosine(first + light) * static_cast<double>(planes_[a].row(light).squaredNorm());
      }
      const auto [column, count] = components_of(a);
      if (count == 0) continue;
      const RowMatrix functions = function_.block(first, column, planes_[a].rows(), count);
      for_blocks(level.value.rows(), kColumns, options_.threads, progress_, [&](Eigen::Index t, Eigen::Index n) {
        level.value.block(t, column, n, count).noalias() += planes_[a].middleCols(t, n).transpose() * functions;
      });
    }
  }

  /// The first component of an axis and their number.
  std::pair<Eigen::Index, Eigen::Index> components_of(size_t axis) const {
    const auto [first, last] = std::equal_range(btf_.axis.begin(), btf_.axis.end(), axis);
    return {first - btf_.axis.begin(), last - first};
  }

  /// Of the light times that of the view.
  double cosine(Eigen::Index pair) const {
    const DirectionPair directions = measurement_.layout().directions(static_cast<uint64_t>(pair));
    return static_cast<double>(std::abs(directions.wl.z * directions.wv.z));
  }

  /// Sum of the squares of what the components make of a level, times both cosines.
  double modelled(const RowMatrix& value) const {
    Eigen::VectorXf weight(function_.rows());
    for (Eigen::Index pair = 0; pair < weight.size(); ++pair) weight[pair] = static_cast<float>(cosine(pair));
    double sum = 0;
    for (size_t a = 0; a < 3; ++a) {
      const auto [column, count] = components_of(a);
      const auto function = function_.middleCols(column, count);
      const Eigen::MatrixXf gram = function.transpose() * weight.asDiagonal() * function;
      const auto values = value.middleCols(column, count);
      sum += static_cast<double>((values * gram).cwiseProduct(values).sum());
    }
    return sum;
  }

  const BtfMeasurement& measurement_;
  const BtfFitOptions& options_;
  Progress& progress_;
  CompandedViews views_;
  std::array<AxisSketch, 3> sketch_;
  RowMatrix function_;  // pair x component
  FactoredBtf btf_{measurement_.layout(), measurement_.grid(), options_.companding, Mat3(1.0f), {}, {}, {}};
  std::vector<float> f_;
  CompandedViews::Planes planes_;
};

}  // namespace

SvdFit fit_svd(const BtfMeasurement& measurement, const BtfFitOptions& options, Progress& progress) {
  if (!measurement.layout().complete()) {
    throw Error(Status::unsupported, "A decomposition needs every view under every light; the BTF has " +
                                         std::to_string(measurement.layout().pairs()) + " pairs alone.");
  }
  return SvdSolver(measurement, options, progress).solve(components_within(options.bytes, measurement));
}

}  // namespace velour

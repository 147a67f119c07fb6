#include "compress/svd_fit.h"

#include <algorithm>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <string>

#include "compress/brightening.h"
#include "compress/fit_memory.h"
#include "compress/side_views.h"
#include "image/half_image.h"
#include "job/error.h"
#include "job/parallel.h"
#include "job/threads.h"
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
constexpr uint64_t kFirstLook = 32;  // components that are looked at first where an error is asked for

template <class Work>
void for_blocks(Eigen::Index extent, Eigen::Index step, int threads, const Progress& progress, const Work& work) {
  parallel_pieces(static_cast<size_t>((extent + step - 1) / step), threads, progress, [&](size_t i) {
    const Eigen::Index first = static_cast<Eigen::Index>(i) * step;
    work(first, std::min(step, extent - first));
  });
}

void orthonormalise(RowMatrix& m) {
  const Eigen::HouseholderQR<Eigen::MatrixXf> qr{Eigen::MatrixXf(m)};
  m = qr.householderQ() * Eigen::MatrixXf::Identity(m.rows(), m.cols());
}

/// The first component of an axis and their number.
std::pair<Eigen::Index, Eigen::Index> components_of(const FactoredBtf& btf, size_t axis) {
  const auto [first, last] = std::equal_range(btf.axis.begin(), btf.axis.end(), axis);
  return {first - btf.axis.begin(), last - first};
}

/// Turns the response into orthonormal functions of the pair, the strongest first.
void rotate(RowMatrix& response, Eigen::VectorXd& energy) {
  const Eigen::MatrixXd exact = response.cast<double>();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(exact.transpose() * exact);
  energy = solver.eigenvalues().reverse().cwiseMax(0.0);
  const Eigen::MatrixXd vectors = solver.eigenvectors().rowwise().reverse();
  Eigen::MatrixXd functions = exact * vectors;
  for (Eigen::Index c = 0; c < functions.cols(); ++c) {
    const double norm = std::sqrt(energy[c]);
    functions.col(c) *= norm > 0 ? 1 / norm : 0;
  }
  response = functions.cast<float>();
}

}  // namespace

SvdFitter::SvdFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
                     Progress& progress)
    : measurement_(measurement),
      options_(options),
      checkpoint_(checkpoint),
      progress_(progress),
      views_(measurement, options.companding, options.threads, progress),
      one_((measurement.layout().pairs() + pyramid_texels(measurement.grid())) * sizeof(HalfBits)) {
  const PairLayout& layout = measurement.layout();
  if (!layout.complete()) {
    throw Error(Status::unsupported, "A decomposition needs every view under every light; the BTF has " +
                                         std::to_string(layout.pairs()) + " pairs alone.");
  }
  const bool all = options.bytes == 0 && options.tolerance > 0;
  const uint64_t usual = std::max(measurement.raw_bytes() / kUsualRatio, kUsualLeast * one_);
  const uint64_t bytes = options.bytes > 0 ? options.bytes : all ? FactoredBtf::kMaxComponents * one_ : usual;
  curve_.points = {{1, one_, 0, 1}};
  bound(bytes, "One component");
  progress.stage("colours", 0, 0.1);
  const ColourAxes colours = find_colours(views_, layout, checkpoint);
  axes_ = colours.axes;
  all_ = colours.all_energy();
  not_finite_ = colours.not_finite;
  const uint64_t most = most_components(bytes);
  uint64_t count = options.tolerance > 0 ? std::min(most, kFirstLook) : most;
  // Half of what is left of the progress for each look.
  for (double begin = 0.1;; begin = (begin + 1) / 2, count = std::min(most, 2 * count)) {
    sketch(count, begin, count == most ? 1.0 : (begin + 1) / 2);
    if (count == most || reaches(options.tolerance)) break;
  }
  bound(bytes, "One component");
}

/// That are looked at.
uint64_t SvdFitter::most_components(uint64_t bytes) const {
  const uint64_t most = std::clamp<uint64_t>(bytes / one_, 1, FactoredBtf::kMaxComponents);
  if (options_.memory == 0) return most;
  const FitExtent extent{.texels = measurement_.grid().texels(),
                         .pyramid_texels = pyramid_texels(measurement_.grid()),
                         .pairs = measurement_.layout().pairs(),
                         .lights = measurement_.layout().lights().size(),
                         .coefficients = most,
                         .threads = static_cast<uint64_t>(arena_concurrency(options_.threads))};
  if (options_.tolerance > 0) return components_within(options_.memory, extent);
  require_components(options_.memory, extent);
  return most;
}

/// Of so many components at least.
void SvdFitter::sketch(uint64_t components, double begin, double end) {
  const auto columns = static_cast<Eigen::Index>(
      std::min({components + kOversampling, measurement_.layout().pairs(), measurement_.grid().texels()}));
  const auto name = [&](int passes) {
    return "sketch." + std::to_string(columns) + "." + std::to_string(passes) + ".";
  };
  int done = kPowerIterations;  // passes onward whose bases were kept
  while (done > 0 && !take_kept_bases(name(done), columns)) --done;
  for (size_t a = 0; a < 3; ++a) {
    if (done == 0) start(sketch_[a], columns, a);
    sketch_[a].response.resize(static_cast<Eigen::Index>(measurement_.layout().pairs()), columns);
  }
  for (int i = done; i <= kPowerIterations; ++i) {
    const double step = (end - begin) / (kPowerIterations + 1);
    progress_.stage("directions", begin + step * i, begin + step * (i + 1));
    pass(i < kPowerIterations);
    if (i == kPowerIterations) break;
    checkpoint_.forget("sketch.");
    for (size_t a = 0; a < 3; ++a) checkpoint_.keep(name(i + 1) + std::to_string(a), sketch_[a].basis);
    checkpoint_.write();
  }
  for (Sketch& s : sketch_) rotate(s.response, s.energy);
  rank();
  set_curve();
}

void SvdFitter::start(Sketch& sketch, Eigen::Index columns, size_t axis) const {
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
  orthonormalise(sketch.basis);
}

bool SvdFitter::take_kept_bases(const std::string& stage, Eigen::Index columns) {
  const auto texels = static_cast<Eigen::Index>(measurement_.grid().texels());
  for (size_t a = 0; a < 3; ++a) {
    auto basis = checkpoint_.matrix(stage + std::to_string(a), texels, columns);
    if (!basis) return false;
    sketch_[a].basis = std::move(*basis);
  }
  return true;
}

/// The response of every view to the basis; when `onward`, also the image of it, which becomes the next basis.
void SvdFitter::pass(bool onward) {
  for (Sketch& s : sketch_) s.image.setZero(s.basis.rows(), onward ? s.basis.cols() : 0);
  for (uint32_t v = 0; v < views_.views(); ++v) {
    progress_.check();
    views_.read(v, f_);
    views_.planes(f_, measurement_.grid().texels(), planes_);
    for (size_t a = 0; a < 3; ++a) respond(sketch_[a], planes_[a], v, onward);
    progress_.update(static_cast<double>(v + 1) / views_.views());
  }
  if (!onward) return;
  for (Sketch& s : sketch_) {
    s.basis = s.image;
    orthonormalise(s.basis);
  }
}

void SvdFitter::respond(Sketch& s, const RowMatrix& plane, uint32_t view, bool onward) const {
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

/// Components of all axes that are more than rounding.
void SvdFitter::rank() {
  ranked_.clear();
  for (uint8_t a = 0; a < 3; ++a) {
    for (Eigen::Index c = 0; c < sketch_[a].energy.size(); ++c) ranked_.push_back({a, c, sketch_[a].energy[c]});
  }
  std::stable_sort(ranked_.begin(), ranked_.end(), [](const auto& x, const auto& y) { return x.energy > y.energy; });
  const double least = kRounding * ranked_.front().energy;
  ranked_.erase(std::find_if(ranked_.begin() + 1, ranked_.end(), [&](const auto& x) { return x.energy <= least; }),
                ranked_.end());
  if (ranked_.size() > FactoredBtf::kMaxComponents) ranked_.resize(FactoredBtf::kMaxComponents);
}

/// What the components leave. Those beyond the weakest one of an axis that was found may be preceded by unknown ones:
/// there the curve is too high, never too low.
void SvdFitter::set_curve() {
  curve_ = {};
  double left = all_;
  for (size_t k = 0; k < ranked_.size(); ++k) {
    left = std::max(0.0, left - ranked_[k].energy);
    curve_.points.push_back({static_cast<int>(k + 1), (k + 1) * one_, 0, all_ > 0 ? std::sqrt(left / all_) : 0.0});
  }
}

bool SvdFitter::reaches(double error) const { return curve_.points.back().relative_l2 <= error; }

ModelBody SvdFitter::fit(size_t point) {
  FactoredBtf btf{measurement_.layout(), measurement_.grid(), options_.companding, axes_, {}, {}, {}};
  choose(point + 1, btf);
  progress_.stage("texels", 0, 1);
  project(btf);
  return btf;
}

void SvdFitter::choose(size_t components, FactoredBtf& btf) {
  std::vector<Component> chosen(ranked_.begin(), ranked_.begin() + static_cast<ptrdiff_t>(components));
  std::sort(chosen.begin(), chosen.end(), [](const Component& x, const Component& y) {
    return std::pair(x.axis, x.column) < std::pair(y.axis, y.column);
  });
  function_.resize(sketch_[0].response.rows(), static_cast<Eigen::Index>(chosen.size()));
  for (const Component& c : chosen) {
    function_.col(static_cast<Eigen::Index>(btf.axis.size())) = sketch_[c.axis].response.col(c.column);
    btf.axis.push_back(c.axis);
  }
  // What is stored is what the texels are projected on.
  btf.pair_value.resize(static_cast<size_t>(function_.size()));
  const std::span<float> values(function_.data(), btf.pair_value.size());
  floats_to_halves(values, btf.pair_value);
  halves_to_floats(btf.pair_value, values);
}

/// Coefficients of every level: products of the functions with the filtered measurement.
void SvdFitter::project(FactoredBtf& btf) {
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
      project(btf, v, levels[l]);
    }
    progress_.update(static_cast<double>(v + 1) / views_.views());
  }
  for (Level& level : levels) {
    level.value *= brightening(options_.companding, level.measured, modelled(btf, level.value));
    TexelLevel stored{level.width, level.height, std::vector<HalfBits>(static_cast<size_t>(level.value.size()))};
    floats_to_halves({level.value.data(), stored.value.size()}, stored.value);
    btf.levels.push_back(std::move(stored));
  }
}

void SvdFitter::project(const FactoredBtf& btf, uint32_t view, Level& level) {
  views_.planes(f_, static_cast<uint64_t>(level.value.rows()), planes_);
  const auto first = static_cast<Eigen::Index>(measurement_.layout().first(view));
  for (size_t a = 0; a < 3; ++a) {
    for (Eigen::Index light = 0; light < planes_[a].rows(); ++light) {
      level.measured += cosine(first + light) * static_cast<double>(planes_[a].row(light).squaredNorm());
    }
    const auto [column, count] = components_of(btf, a);
    if (count == 0) continue;
    const RowMatrix functions = function_.block(first, column, planes_[a].rows(), count);
    for_blocks(level.value.rows(), kColumns, options_.threads, progress_, [&](Eigen::Index t, Eigen::Index n) {
      level.value.block(t, column, n, count).noalias() += planes_[a].middleCols(t, n).transpose() * functions;
    });
  }
}

/// Of the light times that of the view.
double SvdFitter::cosine(Eigen::Index pair) const {
  const DirectionPair directions = measurement_.layout().directions(static_cast<uint64_t>(pair));
  return static_cast<double>(std::abs(directions.wl.z * directions.wv.z));
}

/// Sum of the squares of what the components make of a level, times both cosines.
double SvdFitter::modelled(const FactoredBtf& btf, const RowMatrix& value) const {
  Eigen::VectorXf weight(function_.rows());
  for (Eigen::Index pair = 0; pair < weight.size(); ++pair) weight[pair] = static_cast<float>(cosine(pair));
  double sum = 0;
  for (size_t a = 0; a < 3; ++a) {
    const auto [column, count] = components_of(btf, a);
    const auto function = function_.middleCols(column, count);
    const Eigen::MatrixXf gram = function.transpose() * weight.asDiagonal() * function;
    const auto values = value.middleCols(column, count);
    sum += static_cast<double>((values * gram).cwiseProduct(values).sum());
  }
  return sum;
}

}  // namespace velour

#include "btf/fit/svd/svd_fit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "base/error.h"
#include "base/parallel.h"
#include "btf/fit/relief_pyramid.h"
#include "btf/fit/side_views.h"
#include "image/texels.h"
#include "math/sphere/random.h"
#include "math/tensor/decompositions.h"
#include "math/tensor/tensor_view.h"

namespace velour {

namespace {

// Components with less relative energy are rounding error: their functions are not orthogonal to the others.
constexpr double kRounding = 1e-9;

// Default size: this fraction of the measurement, and a minimum number of components.
constexpr uint64_t kDefaultFactoredRatio = 200, kDefaultMinComponents = 8;

uint64_t component_bytes(const BtfMeasurement& measurement, bool by_view) {
  const PairLayout& layout = measurement.layout();
  const uint64_t rows = by_view ? layout.lights().size() : layout.pairs();
  return (rows + pyramid_texels(measurement.grid())) * sizeof(HalfBits);
}

/// Maximum number of components of any model.
uint64_t most_ever(bool by_view) { return by_view ? FactoredBtf::kMaxOfViews : FactoredBtf::kMaxComponents; }

/// Minimum number of components, if all views have light: a view without a component would be black.
uint64_t least_components(const BtfMeasurement& measurement, bool by_view) {
  return by_view ? measurement.layout().views().size() : 1;
}

uint64_t bytes_of(const BtfMeasurement& measurement, const BtfFitOptions& options, bool by_view) {
  if (options.bytes > 0) return options.bytes;
  const uint64_t one = component_bytes(measurement, by_view);
  if (options.tolerance > 0) return most_ever(by_view) * one;
  const uint64_t least = std::max(kDefaultMinComponents, least_components(measurement, by_view));
  return std::max(measurement.raw_bytes() / kDefaultFactoredRatio, least * one);
}

/// Extent with the number of components that is computed if memory allows.
FitExtent extent_of(const BtfMeasurement& measurement, const BtfFitOptions& options, bool by_view) {
  const uint64_t within = bytes_of(measurement, options, by_view) / component_bytes(measurement, by_view);
  return {.texels = measurement.grid().texels(),
          .pyramid_texels = pyramid_texels(measurement.grid()),
          .pairs = measurement.layout().pairs(),
          .lights = measurement.layout().lights().size(),
          .coefficients = std::clamp<uint64_t>(within, 1, most_ever(by_view)),
          .threads = static_cast<uint64_t>(arena_concurrency(options.threads)),
          .by_view = by_view};
}

void require_complete_pairs(const PairLayout& layout) {
  if (layout.complete()) return;
  throw Error(Status::unsupported,
              "The BTF has only " + std::to_string(layout.pairs()) +
                  " view-light pairs, but a model requires every view under every light. Use a BTF with all pairs.");
}

}  // namespace

FitSize factored_fit_size(const BtfMeasurement& measurement, const BtfFitOptions& options, bool by_view) {
  require_complete_pairs(measurement.layout());
  FitExtent extent = extent_of(measurement, options, by_view);
  FitSize size{.memory = memory_for_components(extent), .bytes = bytes_of(measurement, options, by_view)};
  if (options.tolerance > 0) extent.coefficients = least_components(measurement, by_view);
  size.least_memory = memory_for_components(extent);
  return size;
}

FactoredFitter::FactoredFitter(const BtfMeasurement& measurement, const BtfFitOptions& options,
                               FitCheckpoint& checkpoint, Progress& progress, bool by_view)
    : measurement_(measurement),
      options_(options),
      checkpoint_(checkpoint),
      progress_(progress),
      views_(measurement, options.companding, options.threads, progress),
      by_view_(by_view),
      one_(component_bytes(measurement, by_view)) {
  require_complete_pairs(measurement.layout());
  require_least(1);
}

uint64_t FactoredFitter::bytes() const { return bytes_of(measurement_, options_, by_view_); }

void FactoredFitter::find_axes() {
  const ColorAxes colors = find_colors(views_, measurement_.layout(), checkpoint_);
  axes_ = colors.axes;
  all_ = colors.all_energy();
  not_finite_ = colors.not_finite;
  if (by_view_) require_least(std::max<size_t>(1, colors.lit_views()));
}

void FactoredFitter::require_least(size_t components) {
  least_ = components;
  curve_.points = {{static_cast<int>(least_), least_ * one_, 0, 1}};
  bound_components();
}

void FactoredFitter::bound_components() {
  bound(bytes(), least_ == 1 ? "One component"
                             : "One component for each of the " + std::to_string(least_) + " views that are not black");
}

uint64_t FactoredFitter::most_components() const {
  const FitExtent extent = extent_of(measurement_, options_, by_view_);
  if (options_.memory == 0) return extent.coefficients;
  if (options_.tolerance > 0)
    return components_within(options_.memory, least_components(measurement_, by_view_), extent);
  require_components(options_.memory, extent);
  return extent.coefficients;
}

void FactoredFitter::rank(std::vector<Component> components, size_t most) {
  ranked_ = std::move(components);
  std::stable_sort(ranked_.begin(), ranked_.end(), [](const auto& x, const auto& y) { return x.energy > y.energy; });
  const double rounding = kRounding * ranked_.front().energy;
  std::vector<bool> has_component(by_view_ ? views_.views() : 1, false);
  const auto others = std::stable_partition(ranked_.begin(), ranked_.end(), [&](const Component& x) {
    const bool first = x.energy > 0 && !has_component[x.view];
    if (first) has_component[x.view] = true;
    return first;
  });
  const auto kept = std::max(others, ranked_.begin() + 1);
  ranked_.erase(std::find_if(kept, ranked_.end(), [&](const auto& x) { return x.energy <= rounding; }), ranked_.end());
  if (ranked_.size() > most) ranked_.resize(most);
  least_ = std::min(least_, ranked_.size());
  curve_ = {};
  double left = all_;
  for (size_t k = 1; k <= ranked_.size(); ++k) {
    left = std::max(0.0, left - ranked_[k - 1].energy);
    if (k < least_) continue;
    curve_.points.push_back({static_cast<int>(k), k * one_, 0, all_ > 0 ? std::sqrt(left / all_) : 0.0});
  }
}

ModelBody FactoredFitter::fit(size_t point) {
  FactoredBtf btf{measurement_.layout(), measurement_.grid(), options_.companding, axes_, {}, {}, {}};
  choose(static_cast<size_t>(curve_.points[point].lobes), btf);
  progress_.stage("fitting texels", 0, 1);
  project(btf);
  return btf;
}

void FactoredFitter::choose(size_t components, FactoredBtf& btf) {
  std::vector<Component> chosen(ranked_.begin(), ranked_.begin() + static_cast<ptrdiff_t>(components));
  std::sort(chosen.begin(), chosen.end(), [](const Component& x, const Component& y) {
    return std::tuple(x.view, x.axis, x.column) < std::tuple(y.view, y.axis, y.column);
  });
  for (const Component& c : chosen) {
    btf.axis.push_back(c.axis);
    if (by_view_) btf.view.push_back(static_cast<uint16_t>(c.view));
  }
  function_.resize(static_cast<Eigen::Index>(btf.function_rows()), static_cast<Eigen::Index>(chosen.size()));
  Eigen::VectorXf values(function_.rows());
  for (Eigen::Index k = 0; k < function_.cols(); ++k) {
    copy_function(chosen[static_cast<size_t>(k)], values);
    function_.col(k) = values;
  }
  // Texels are projected on the functions as stored.
  btf.pair_value.resize(static_cast<size_t>(function_.size()));
  const std::span<float> stored(function_.data(), btf.pair_value.size());
  floats_to_halves(stored, btf.pair_value);
  halves_to_floats(btf.pair_value, stored);
}

/// Computes the coefficients of every level: products of the functions with the filtered measurement.
void FactoredFitter::project(FactoredBtf& btf) {
  const ComponentRanges ranges(btf);
  std::vector<Level> levels;
  uint32_t width = measurement_.grid().width, height = measurement_.grid().height;
  for (;; width = half_of(width), height = half_of(height)) {
    levels.push_back({width, height, RowMatrix::Zero(Eigen::Index{width} * height, function_.cols()),
                      std::vector<double>(ranges.groups(), 0.0)});
    if (width == 1 && height == 1) break;
  }
  for (uint32_t v = 0; v < views_.views(); ++v) {
    progress_.check();
    views_.read(v, f_);
    for (size_t l = 0; l < levels.size(); ++l) {
      if (l > 0) f_ = halved_images(f_, levels[l - 1].width, levels[l - 1].height);
      project(btf, ranges, v, levels[l]);
    }
    progress_.update(static_cast<double>(v + 1) / views_.views());
  }
  for (Level& level : levels) brighten(btf, ranges, level);
  scale_to_halves(levels, btf);
  for (const Level& level : levels) {
    TexelLevel stored{level.width, level.height, std::vector<HalfBits>(static_cast<size_t>(level.value.size()))};
    floats_to_halves({level.value.data(), stored.value.size()}, stored.value);
    btf.levels.push_back(std::move(stored));
  }
}

/// Moves a power of two from the texels of each component that exceeds the range of halves to its function. The values
/// of a function are at most 1, so it has room, and they remain the same halves but for their exponents.
void FactoredFitter::scale_to_halves(std::vector<Level>& levels, FactoredBtf& btf) {
  const auto fits = [](const Level& level) { return level.value.cwiseAbs().maxCoeff() <= kLargestHalf; };
  if (std::all_of(levels.begin(), levels.end(), fits)) return;
  for (Eigen::Index c = 0; c < function_.cols(); ++c) {
    float most = 0;
    for (const Level& level : levels) most = std::max(most, level.value.col(c).cwiseAbs().maxCoeff());
    if (!(most > kLargestHalf)) continue;
    const float factor = std::exp2(std::ceil(std::log2(most / kLargestHalf)));
    for (Level& level : levels) level.value.col(c) /= factor;
    function_.col(c) *= factor;
  }
  floats_to_halves({function_.data(), btf.pair_value.size()}, btf.pair_value);
}

void FactoredFitter::project(const FactoredBtf& btf, const ComponentRanges& ranges, uint32_t view, Level& level) {
  views_.planes(f_, static_cast<uint64_t>(level.value.rows()), planes_);
  const auto first_pair = static_cast<Eigen::Index>(measurement_.layout().first(view));
  const auto first_row = static_cast<Eigen::Index>(btf.first_row(view));
  double& measured = level.measured[ranges.groups() == 1 ? 0 : view];
  for (size_t a = 0; a < 3; ++a) {
    for (Eigen::Index light = 0; light < planes_[a].rows(); ++light) {
      measured += cosine(first_pair + light) * static_cast<double>(planes_[a].row(light).squaredNorm());
    }
    const auto range = ranges.of(view, a);
    const Eigen::Index column = range.begin, count = range.count();
    if (count == 0) continue;
    const RowMatrix functions = function_.block(first_row, column, planes_[a].rows(), count);
    for_blocks(level.value.rows(), kBlockColumns, options_.threads, progress_, [&](Eigen::Index t, Eigen::Index n) {
      level.value.block(t, column, n, count).noalias() += planes_[a].middleCols(t, n).transpose() * functions;
    });
  }
}

/// Corrects each group of components separately, because no view can make up for another.
void FactoredFitter::brighten(const FactoredBtf& btf, const ComponentRanges& ranges, Level& level) const {
  for (size_t group = 0; group < ranges.groups(); ++group) {
    const auto range = ranges.of(group);
    const double sum = modelled(btf, ranges, group, level.value);
    level.value.middleCols(range.begin, range.count()) *= brightening(options_.companding, level.measured[group], sum);
  }
}

/// Cosine of the light times that of the view.
double FactoredFitter::cosine(Eigen::Index pair) const {
  const DirectionPair directions = measurement_.layout().directions(static_cast<uint64_t>(pair));
  return static_cast<double>(std::abs(directions.wl.z * directions.wv.z));
}

/// Sum of squares of a level as modeled by a group's components, times both cosines.
double FactoredFitter::modelled(const FactoredBtf& btf, const ComponentRanges& ranges, size_t group,
                                const RowMatrix& value) const {
  const Eigen::Index first = btf.by_view() ? static_cast<Eigen::Index>(btf.layout.first(group)) : 0;
  Eigen::VectorXf weight(function_.rows());
  for (Eigen::Index row = 0; row < weight.size(); ++row) weight[row] = static_cast<float>(cosine(first + row));
  double sum = 0;
  for (size_t a = 0; a < 3; ++a) {
    const auto range = ranges.of(group, a);
    const auto function = function_.middleCols(range.begin, range.count());
    const Eigen::MatrixXf gram = function.transpose() * weight.asDiagonal() * function;
    const auto values = value.middleCols(range.begin, range.count());
    sum += static_cast<double>((values * gram).cwiseProduct(values).sum());
  }
  return sum;
}

namespace {

constexpr int kPowerIterations = 2;
constexpr int kOversampling = 8;     // columns beyond the requested ones
constexpr uint64_t kFirstLook = 32;  // components to start with if a tolerance is given

std::string basis_stage(Eigen::Index columns, int passes, size_t axis) {
  return "sketch." + std::to_string(columns) + "." + std::to_string(passes) + "." + std::to_string(axis);
}

/// Turns the response into orthonormal functions of the pair, the strongest first.
void rotate(RowMatrix& response, Eigen::VectorXd& energy) {
  const Eigen::MatrixXd exact = response.cast<double>();
  const Eigenpairs pairs = eigenpairs(exact.transpose() * exact);
  energy = pairs.value.cwiseMax(0.0);
  Eigen::MatrixXd functions = exact * pairs.vector;
  for (Eigen::Index c = 0; c < functions.cols(); ++c) {
    const double norm = std::sqrt(energy[c]);
    functions.col(c) *= norm > 0 ? 1 / norm : 0;
  }
  response = functions.cast<float>();
}

}  // namespace

SvdFitter::SvdFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
                     Progress& progress)
    : FactoredFitter(measurement, options, checkpoint, progress, false) {
  progress.stage("computing color axes", 0, 0.1);
  find_axes();
  const uint64_t most = most_components();
  uint64_t count = first_sketch(most);
  // Each sketch gets half of the remaining progress.
  for (double begin = 0.1;; begin = (begin + 1) / 2, count = std::min(most, 2 * count)) {
    sketch(count, begin, count == most ? 1.0 : (begin + 1) / 2);
    if (count == most || reaches(options.tolerance)) break;
  }
  bound_components();
}

/// Number of components of the first sketch. A stored sketch was only begun because smaller ones did not reach the
/// tolerance.
uint64_t SvdFitter::first_sketch(uint64_t most) {
  if (options_.tolerance == 0) return most;
  for (uint64_t count = kFirstLook; count < 2 * most; count *= 2) {
    if (take_kept_bases(columns_for(std::min(most, count))) > 0) return std::min(most, count);
  }
  return std::min(most, kFirstLook);
}

Eigen::Index SvdFitter::columns_for(uint64_t components) const {
  return static_cast<Eigen::Index>(
      std::min({components + kOversampling, measurement_.layout().pairs(), measurement_.grid().texels()}));
}

/// Finds at least `components` components.
void SvdFitter::sketch(uint64_t components, double begin, double end) {
  const Eigen::Index columns = columns_for(components);
  const int done = take_kept_bases(columns);
  for (size_t a = 0; a < 3; ++a) {
    if (done == 0) start(sketch_[a], columns, a);
    sketch_[a].response.resize(static_cast<Eigen::Index>(measurement_.layout().pairs()), columns);
  }
  for (int i = done; i <= kPowerIterations; ++i) {
    const double step = (end - begin) / (kPowerIterations + 1);
    progress_.stage("computing direction functions", begin + step * i, begin + step * (i + 1));
    pass(i < kPowerIterations);
    if (i == kPowerIterations) break;
    checkpoint_.forget("sketch.");
    for (size_t a = 0; a < 3; ++a) checkpoint_.keep(basis_stage(columns, i + 1, a), sketch_[a].basis);
    checkpoint_.write();
  }
  for (Sketch& s : sketch_) rotate(s.response, s.energy);
  rank(found(), FactoredBtf::kMaxComponents);
}

void SvdFitter::start(Sketch& sketch, Eigen::Index columns, size_t axis) const {
  const auto texels = static_cast<Eigen::Index>(measurement_.grid().texels());
  sketch.basis.resize(texels, columns);
  for (Eigen::Index t = 0; t < texels; ++t) {
    RandomStream random(options_.seed, static_cast<uint64_t>(t), axis);
    // The sum of three uniform numbers is close enough to normal.
    for (Eigen::Index c = 0; c < columns; ++c) {
      const float u = random.next(), v = random.next();
      sketch.basis(t, c) = u + v + random.next() - 1.5f;
    }
  }
  sketch.basis = orthonormal(sketch.basis);
}

/// Restores the bases of a sketch; returns the number of passes that they have had, or 0 if none are stored.
int SvdFitter::take_kept_bases(Eigen::Index columns) {
  const auto texels = static_cast<Eigen::Index>(measurement_.grid().texels());
  for (int passes = kPowerIterations; passes > 0; --passes) {
    size_t taken = 0;
    for (; taken < 3; ++taken) {
      auto basis = checkpoint_.matrix(basis_stage(columns, passes, taken), texels, columns);
      if (!basis) break;
      sketch_[taken].basis = std::move(*basis);
    }
    if (taken == 3) return passes;
  }
  return 0;
}

/// Computes the response of every view to the basis; if `onward`, also its image, which becomes the next basis.
void SvdFitter::pass(bool continuation) {
  for (Sketch& s : sketch_) s.image.setZero(s.basis.rows(), continuation ? s.basis.cols() : 0);
  for (uint32_t v = 0; v < views_.views(); ++v) {
    progress_.check();
    views_.read(v, f_);
    views_.planes(f_, measurement_.grid().texels(), planes_);
    for (size_t a = 0; a < 3; ++a) respond(sketch_[a], planes_[a], v, continuation);
    progress_.update(static_cast<double>(v + 1) / views_.views());
  }
  if (!continuation) return;
  for (Sketch& s : sketch_) {
    s.basis = s.image;
    s.basis = orthonormal(s.basis);
  }
}

void SvdFitter::respond(Sketch& s, const RowMatrix& plane, uint32_t view, bool continuation) const {
  const auto first = static_cast<Eigen::Index>(measurement_.layout().first(view));
  for_blocks(plane.rows(), kBlockRows, options_.threads, progress_, [&](Eigen::Index row, Eigen::Index count) {
    s.response.middleRows(first + row, count).noalias() = plane.middleRows(row, count) * s.basis;
  });
  if (!continuation) return;
  const auto response = s.response.middleRows(first, plane.rows());
  for_blocks(plane.cols(), kBlockColumns, options_.threads, progress_, [&](Eigen::Index column, Eigen::Index count) {
    s.image.middleRows(column, count).noalias() += plane.middleCols(column, count).transpose() * response;
  });
}

std::vector<SvdFitter::Component> SvdFitter::found() const {
  std::vector<Component> components;
  for (uint8_t a = 0; a < 3; ++a) {
    for (Eigen::Index c = 0; c < sketch_[a].energy.size(); ++c) components.push_back({0, a, c, sketch_[a].energy[c]});
  }
  return components;
}

bool SvdFitter::reaches(double error) const { return curve_.points.back().relative_l2 <= error; }

void SvdFitter::copy_function(const Component& component, Eigen::Ref<Eigen::VectorXf> values) const {
  values = sketch_[component.axis].response.col(component.column);
}

namespace {

constexpr double kViewColors = 0.3;  // fraction of the progress at which they end

/// Number of components kept per view and axis.
uint64_t columns_of(const BtfMeasurement& measurement) {
  return std::min<uint64_t>(
      {measurement.layout().lights().size(), measurement.grid().texels(), FactoredBtf::kMaxOfView / 3});
}

}  // namespace

ViewSvdFitter::ViewSvdFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
                             Progress& progress)
    : FactoredFitter(measurement, options, checkpoint, progress, true) {
  const uint64_t most = most_components();
  progress.stage("computing color axes", 0, kViewColors);
  find_axes();
  progress.stage("computing direction functions", kViewColors, 1);
  std::vector<Component> components;
  function_of_.resize(views_.views());
  for (uint32_t v = 0; v < views_.views(); ++v) {
    progress.check();
    decompose(v, components);
    progress.update(static_cast<double>(v + 1) / views_.views());
  }
  rank(std::move(components), most);
  bound_components();
}

void ViewSvdFitter::decompose(uint32_t view, std::vector<Component>& components) {
  views_.read(view, f_);
  views_.planes(f_, measurement_.grid().texels(), planes_);
  const auto columns = static_cast<Eigen::Index>(columns_of(measurement_));
  for (uint8_t a = 0; a < 3; ++a) {
    const TensorView plane(planes_[a].data(), {planes_[a].rows(), planes_[a].cols()});
    const Eigenpairs pairs = eigenpairs(slice_products(plane, 0, options_.threads, progress_));
    function_of_[view][a] = pairs.vector.leftCols(columns).cast<float>();
    const Eigen::VectorXd energy = pairs.value.cwiseMax(0.0);
    for (Eigen::Index c = 0; c < columns; ++c) components.push_back({view, a, c, energy[c]});
  }
}

void ViewSvdFitter::copy_function(const Component& component, Eigen::Ref<Eigen::VectorXf> values) const {
  values = function_of_[component.view][component.axis].col(component.column);
}

}  // namespace velour

#include "btf/fit/tensor/tensor_fit.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "btf/fit/btf_compare.h"
#include "btf/fit/relief_pyramid.h"
#include "btf/fit/tensor/tensor_checkpoint.h"
#include "btf/fit/tensor/tensor_functions.h"
#include "btf/fit/tensor/tensor_texels.h"
#include "math/tensor/cluster_fit.h"

namespace velour {
namespace {

constexpr Index kDirections = 64;                              // maximum ranks of the bases of views and lights
constexpr size_t kMinBasisPoints = 64, kMaxBasisPoints = 700;  // for computing bases
constexpr int kTensorIterations = 30;
constexpr double kTensorTolerance = 1e-4;
constexpr uint64_t kDefaultTensorRatio = 400, kUsualTexel = 16, kUsualCluster = 20000;
constexpr double kFinest = 20;    // with a tolerance: size of the measurement over that of the largest model
constexpr double kStep = 1.2;     // ratio of one size to the next
constexpr double kFall = 0.3;     // errors fall roughly as the bytes to this power
constexpr double kShare = 0.625;  // sides share the bytes by this power of their energies; 1 / (1 + 2 kFall) is optimal
constexpr double kTensorColors = 0.15, kBases = 0.1, kReduced = 0.25, kShapes = 0.6, kFitted = 0.9,
                 kClusters = 0.5;  // where parts of the progress end

FitExtent extent_of(const BtfMeasurement& measurement) {
  return {.texels = measurement.grid().texels(),
          .pyramid_texels = pyramid_texels(measurement.grid()),
          .pairs = measurement.layout().pairs(),
          .lights = measurement.layout().lights().size()};
}

/// Entries of a slice to be clustered.
uint64_t entries_of(const PairLayout& layout) {
  const auto rank = [](size_t directions) { return std::min<uint64_t>(directions, kDirections); };
  return rank(layout.views().size()) * rank(layout.lights().size()) * 3;
}

uint64_t bytes_of(const BtfMeasurement& measurement, const BtfFitOptions& options, size_t sides) {
  if (options.bytes > 0) return options.bytes;
  const uint64_t least = pyramid_texels(measurement.grid()) * kUsualTexel + kUsualCluster;
  return std::max<uint64_t>(measurement.raw_bytes() / kDefaultTensorRatio, sides * least);
}

std::string text_of(const TensorShape& shape) {
  std::string text = std::to_string(shape.clusters);
  for (const uint32_t n : {shape.members, shape.rank.texel, shape.rank.view, shape.rank.light, shape.rank.color}) {
    text += '-' + std::to_string(n);
  }
  return text;
}

}  // namespace

FitSize tensor_fit_size(const BtfMeasurement& measurement, const BtfFitOptions& options) {
  require_complete(measurement.layout());
  const FitExtent extent = extent_of(measurement);
  const uint64_t entries = entries_of(measurement.layout());
  return {memory_for_tensors(extent, entries, {}), memory_for_tensors(extent, entries, least_tensor_allowance()),
          bytes_of(measurement, options, sides_of(measurement.layout()).size())};
}

TensorFitter::TensorFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, const ShapeRange& range,
                           FitCheckpoint& checkpoint, Progress& progress)
    : measurement_(measurement),
      options_(options),
      checkpoint_(checkpoint),
      progress_(progress),
      views_(measurement, options.companding, options.threads, progress) {
  require_complete(measurement.layout());
  allowance_ = tensor_allowance(options.memory, extent_of(measurement), entries_of(measurement.layout()));
  progress.stage("computing color axes", 0, kTensorColors);
  const ColorAxes colors = find_colors(views_, measurement.layout(), checkpoint);
  axes_ = colors.axes;
  not_finite_ = colors.not_finite;
  find_sides(colors);
  const uint64_t bytes = bytes_of(measurement, options, sides_.size());
  uint64_t least = 0;
  for (size_t s = 0; s < sides_.size(); ++s) least += tensor_bytes({}, extent(s));
  curve_.points = {{1, least, 0, 1}};
  bound(bytes, "The smallest model");
  const double share = (1 - kTensorColors) / static_cast<double>(sides_.size());
  for (size_t s = 0; s < sides_.size(); ++s) {
    const Progress::Span of_side(progress_, kTensorColors + share * static_cast<double>(s),
                                 kTensorColors + share * static_cast<double>(s + 1));
    find_shape(s, side_bytes(s, bytes), range);
    settle_rival(s);
    shapes_.insert(shapes_.end(), sides_[s].found.trials.begin(), sides_[s].found.trials.end());
  }
  set_curve(bytes);
  bound(options.bytes == 0 && options.tolerance > 0 ? ~uint64_t{0} : bytes, "The smallest model");
}

void TensorFitter::find_sides(const ColorAxes& colors) {
  FittedSides found = fitted_sides(measurement_, colors, progress_);
  shared_ = std::move(found.shared);
  for (FittedSide& side : found.sides) {
    std::vector<Relief> relief =
        options_.relief ? relief_pyramid(measurement_, side.directions) : plane_pyramid(measurement_.grid());
    sides_.push_back({std::move(side.directions), side.energy, std::move(relief), {}, 0, {}, {}, {}});
  }
}

TensorSource TensorFitter::source(size_t side) const {
  const Side& of = sides_[side];
  return {measurement_.grid(), of.directions, of.relief, options_.seed, options_.threads, allowance_.inverse_bytes};
}

TensorExtent TensorFitter::extent(size_t side) const {
  const Side& of = sides_[side];
  const auto rank = [](size_t directions) { return static_cast<uint32_t>(std::min<size_t>(directions, kDirections)); };
  TensorExtent extent{
      pyramid_texels(measurement_.grid()), measurement_.grid().texels(), of.directions.view.size(),
      of.directions.light.size(),          !is_plane(of.relief[0]),      rank(of.directions.view.size()),
      rank(of.directions.light.size()),    allowance_.functions};
  if (of.found.view_rank > 0) {
    extent.view_rank = of.found.view_rank;
    extent.light_rank = of.found.light_rank;
  } else if (of.bases) {
    extent.view_rank = static_cast<uint32_t>(of.bases->view.vector.cols());
    extent.light_rank = static_cast<uint32_t>(of.bases->light.vector.cols());
  }
  return extent;
}

/// The minimum of a side, and its share of the remaining bytes.
uint64_t TensorFitter::side_bytes(size_t side, uint64_t bytes) const {
  double all = 0;
  uint64_t least = 0;
  for (size_t s = 0; s < sides_.size(); ++s) {
    all += std::pow(sides_[s].energy, kShare);
    least += tensor_bytes({}, extent(s));
  }
  const double share = all > 0 ? std::pow(sides_[side].energy, kShare) / all : 1 / static_cast<double>(sides_.size());
  const double rest = bytes > least ? static_cast<double>(bytes - least) : 0.0;
  return tensor_bytes({}, extent(side)) + static_cast<uint64_t>(share * rest);
}

/// Computes the bases and the texels to be clustered.
void TensorFitter::reduce(size_t side) {
  Side& of = sides_[side];
  if (of.reduced) return;
  const size_t a_point = of.directions.view.size() * of.directions.light.size() * 3;
  const size_t points = std::clamp(allowance_.point_floats / a_point, kMinBasisPoints, kMaxBasisPoints);
  progress_.stage("computing direction functions", 0, kBases);
  of.bases = direction_bases(views_, source(side), kDirections, points, progress_);
  progress_.stage("sampling texels", kBases, kReduced);
  std::vector<uint32_t> texels =
      random_texels(measurement_.grid().texels(), allowance_.slices / sides_.size(), options_.seed);
  of.reduced = reduced_texels(views_, source(side), *of.bases, std::move(texels), progress_);
}

void TensorFitter::find_shape(size_t side, uint64_t bytes, const ShapeRange& range) {
  Side& of = sides_[side];
  of.found_bytes = bytes;
  if (auto kept = kept_shape(checkpoint_, side_stage(side) + ".shape")) {
    of.found = std::move(*kept);
    return;
  }
  reduce(side);
  const Progress::Span shapes(progress_, kReduced, kShapes);
  of.found =
      search_shape(of.reduced->slices.view(),
                   {range, extent(side), bytes, of.reduced->relief_share, options_.seed, options_.threads}, progress_);
  keep_shape(checkpoint_, side_stage(side) + ".shape", of.found);
}

/// Decides between two shapes by their errors on the images.
void TensorFitter::settle_rival(size_t side) {
  Side& of = sides_[side];
  if (!of.found.rival) return;
  const JudgedShape rivals[] = {of.found.best, *of.found.rival};
  double least = 0;
  for (size_t i = 0; i < 2; ++i) {
    const double half = (1 - kShapes) / 2;
    const Progress::Span one(progress_, kShapes + half * static_cast<double>(i),
                             kShapes + half * static_cast<double>(i + 1));
    TensorSide fitted = [&] {
      const Progress::Span fitting(progress_, 0, kFitted);
      return fit_side(side, rivals[i].shape);
    }();
    const double error = error_of(fitted);
    if (i > 0 && error >= least) continue;
    least = error;
    of.found.best = rivals[i];
    of.fitted = std::move(fitted);
  }
  of.found.rival.reset();
  keep_shape(checkpoint_, side_stage(side) + ".shape", of.found);
  if (options_.tolerance == 0) of.reduced.reset();
}

/// Error of a model with this side alone.
double TensorFitter::error_of(const TensorSide& side) {
  const ModelBody alone = TensorBtf{measurement_.layout(), measurement_.grid(), options_.companding, axes_, {side}, {}};
  progress_.stage("measuring the error", kFitted, 1);
  return compare_btf(measurement_, images_of(alone), {.companding = options_.companding}, options_.threads, progress_)
      .relative_l2;
}

/// For smaller sizes, the shape found with half the clusters per fourth of the bytes, unless their number is given.
std::optional<TensorShape> TensorFitter::shape_of(size_t side, uint64_t bytes) const {
  const Side& of = sides_[side];
  if (bytes == of.found_bytes) return of.found.best.shape;
  ShapeChoice choice = of.found.best.choice;
  for (double ratio = static_cast<double>(of.found_bytes) / static_cast<double>(bytes); ratio >= 4; ratio /= 4) {
    if (options_.clusters == 0) choice.clusters = std::max((choice.clusters + 1) / 2, choice.members);
  }
  return largest_shape(choice, extent(side), bytes);
}

/// A single size without a tolerance, otherwise a ladder of sizes.
void TensorFitter::set_curve(uint64_t bytes) {
  double left = 0, relief = 0, all = 0;
  for (const Side& of : sides_) {
    const double error = of.found.best.error;
    left += of.energy * std::max(error * error - of.found.relief_error, 0.0);
    relief += of.energy * of.found.relief_error;
    all += of.energy;
  }
  const auto expected = [&](uint64_t size) {
    const double ratio = static_cast<double>(size) / static_cast<double>(bytes);
    return all > 0 ? std::sqrt((left * std::pow(ratio, -2 * kFall) + relief) / all) : 0.0;
  };
  std::vector<uint64_t> ladder{bytes};
  if (options_.tolerance > 0) {
    const double most = options_.bytes > 0 ? static_cast<double>(bytes)
                                           : std::max(static_cast<double>(bytes),
                                                      static_cast<double>(measurement_.raw_bytes()) / kFinest);
    for (double b = static_cast<double>(bytes) / kStep; b >= static_cast<double>(curve_.points[0].parameter_bytes);
         b /= kStep) {
      ladder.insert(ladder.begin(), static_cast<uint64_t>(b));
    }
    for (double b = static_cast<double>(bytes) * kStep; b <= most; b *= kStep)
      ladder.push_back(static_cast<uint64_t>(b));
  }
  curve_ = {};
  for (const uint64_t size : ladder) {
    OrderPoint point;
    bool sound = true;
    for (size_t s = 0; s < sides_.size() && sound; ++s) {
      const auto shape = shape_of(s, side_bytes(s, size));
      sound = shape.has_value();
      if (!sound) break;
      point.lobes = std::max(point.lobes, static_cast<int>(shape->coefficients()));
      point.parameter_bytes += tensor_bytes(*shape, extent(s));
    }
    if (!sound || (!curve_.points.empty() && point.parameter_bytes <= curve_.points.back().parameter_bytes)) continue;
    point.relative_l2 = expected(size);
    curve_.points.push_back(point);
    bytes_.push_back(size);
  }
}

ModelBody TensorFitter::fit(size_t point) {
  TensorBtf btf{measurement_.layout(), measurement_.grid(), options_.companding, axes_, {}, shared_};
  const double share = 1.0 / static_cast<double>(sides_.size());
  for (size_t s = 0; s < sides_.size(); ++s) {
    const Progress::Span of_side(progress_, share * static_cast<double>(s), share * static_cast<double>(s + 1));
    const uint64_t bytes = side_bytes(s, bytes_[point]);
    const Side& side = sides_[s];
    btf.sides.push_back(side.fitted && bytes == side.found_bytes ? *side.fitted
                                                                 : fit_side(s, shape_of(s, bytes).value()));
  }
  return btf;
}

TensorSide TensorFitter::fit_side(size_t side, const TensorShape& shape) {
  const SideDirections& directions = sides_[side].directions;
  TensorSide fitted{directions.view_below, directions.light_below, shape.rank, shape.members, {}, {}};
  fitted.clusters.resize(shape.clusters);
  const std::string stage = "fit." + side_stage(side) + '.' + text_of(shape);
  set_clusters(side, stage + ".cluster.", fitted);
  const Progress::Span texels(progress_, kClusters, 1);
  solve_tensor_levels(views_, source(side), options_.companding, checkpoint_, stage + ".level.", progress_, fitted);
  return fitted;
}

void TensorFitter::set_clusters(size_t side, const std::string& stage, TensorSide& fitted) {
  Side& of = sides_[side];
  if (take_kept_clusters(checkpoint_, stage, of.directions, fitted)) return;
  {
    const Progress::Span reading(progress_, 0, kClusters / 2);
    reduce(side);
  }
  progress_.stage("clustering texels", kClusters / 2, kClusters);
  const TensorSide::Ranks& rank = fitted.rank;
  const ClusterFit found = fit_clusters(of.reduced->slices.view(),
                                        {.clusters = static_cast<Index>(fitted.clusters.size()),
                                         .members = fitted.members,
                                         .ranks = {rank.texel, rank.view, rank.light, rank.color},
                                         .iterations = kTensorIterations,
                                         .tolerance = kTensorTolerance,
                                         .tensor = {options_.seed, options_.threads}},
                                        progress_);
  fitted.clusters = stored_clusters(found.tensor, *of.bases);
  keep_clusters(checkpoint_, stage, fitted);
  if (options_.tolerance > 0 || of.found.rival) return;  // another size or shape may follow
  of.reduced.reset();
}

}  // namespace velour

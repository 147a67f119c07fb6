#include "compress/srbf_fit.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "compress/fitted_sides.h"
#include "compress/lobe_checkpoint.h"
#include "compress/relief_pyramid.h"
#include "compress/texel_levels.h"
#include "job/error.h"
#include "job/threads.h"

namespace velour {
namespace {

constexpr uint32_t kMaxLobePoints = 400, kMinLobePoints = 24, kPairs = 900;  // for refining lobes
constexpr uint64_t kTexelsOfAPoint = 4;  // small BTFs need fewer points, which saves time
constexpr int kRefinements = 100;
constexpr uint64_t kDefaultSrbfRatio = 400, kDefaultMinLobes = 16;
constexpr size_t kMostCoefficients = 2 * SrbfBtf::kMaxLobes;
// Errors over all texels and pairs exceed those of the order at the points: by a factor of 1.3 to 1.9 for captured
// weaves and gravels. Fits correct this guess.
constexpr double kHeight = 1.4;
// The curve extends to models of twice the size, or to a third of the requested error.
constexpr size_t kBeyond = 2;
constexpr double kBelow = 0.3;
constexpr double kSrbfColors = 0.2, kPoints = 0.1, kLobes = 0.45;  // where parts of the progress end

uint32_t points_for(const TexelGrid& grid) {
  return static_cast<uint32_t>(std::clamp<uint64_t>(grid.texels() / kTexelsOfAPoint, kMinLobePoints, kMaxLobePoints));
}

uint64_t usual_bytes(const BtfMeasurement& measurement, size_t sides) {
  const uint64_t least = srbf_side_bytes(pyramid_texels(measurement.grid()), kDefaultMinLobes, kDefaultMinLobes);
  return std::max(measurement.raw_bytes() / kDefaultSrbfRatio, sides * least);
}

/// Upper bound on coefficients if one side gets the whole budget.
size_t most_coefficients(uint64_t bytes, uint64_t texels) {
  const uint64_t one = srbf_side_bytes(texels, 1, 0) - srbf_side_bytes(texels, 0, 0);
  return static_cast<size_t>(std::clamp<uint64_t>(bytes / one, 1, kMostCoefficients));
}

/// Maximum number of coefficients to consider.
size_t most_coefficients(const BtfMeasurement& measurement, const BtfFitOptions& options, uint64_t bytes) {
  if (options.bytes == 0 && options.tolerance > 0) return kMostCoefficients;
  return std::min(kBeyond * most_coefficients(bytes, pyramid_texels(measurement.grid())), kMostCoefficients);
}

/// `side`: one of `sides` sides.
FitExtent extent_of(const BtfMeasurement& measurement, const BtfFitOptions& options, const SideDirections& side,
                    size_t sides, size_t most) {
  const PairLayout& layout = measurement.layout();
  return {.texels = measurement.grid().texels(),
          .pyramid_texels = pyramid_texels(measurement.grid()),
          .pairs = layout.pairs(),
          .lights = layout.lights().size(),
          .sides = sides,
          .points = points_for(measurement.grid()),
          .point_pairs = std::min<uint64_t>(kPairs, side.view.size() * side.light.size()),
          .coefficients = most,
          .threads = static_cast<uint64_t>(arena_concurrency(options.threads))};
}

}  // namespace

FitSize srbf_fit_size(const BtfMeasurement& measurement, const BtfFitOptions& options) {
  require_complete(measurement.layout());
  const std::vector<SideDirections> sides = sides_of(measurement.layout());
  const uint64_t bytes = options.bytes > 0 ? options.bytes : usual_bytes(measurement, sides.size());
  const size_t most = most_coefficients(measurement, options, bytes);
  const FitExtent extent = extent_of(measurement, options, sides.front(), sides.size(), most);
  return {memory_for_all_points(extent), memory_for_least_points(extent), bytes};
}

SrbfFitter::SrbfFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
                       Progress& progress)
    : measurement_(measurement),
      options_(options),
      checkpoint_(checkpoint),
      progress_(progress),
      views_(measurement, options.companding, options.threads, progress) {
  require_complete(measurement.layout());
  progress.stage("computing color axes", 0, kSrbfColors);
  const ColourAxes colours = find_colours(views_, measurement.layout(), checkpoint);
  axes_ = colours.axes;
  not_finite_ = colours.not_finite;
  find_sides(colours);
  const bool all = options.bytes == 0 && options.tolerance > 0;
  const uint64_t bytes = options.bytes > 0 ? options.bytes : usual_bytes(measurement, sides_.size());
  const uint64_t texels = pyramid_texels(measurement.grid());
  curve_.points = {{1, sides_.size() * srbf_side_bytes(texels, 1, 1), 0, 1}};
  bound(bytes, "The smallest model");
  find_orders(bytes);
  shares_.emplace(demand_, texels);
  curve_ = shares_->curve();
  for (OrderPoint& point : curve_.points) point.relative_l2 *= kHeight;
  bound(all ? ~uint64_t{0} : bytes, "The smallest model");
}

void SrbfFitter::find_sides(const ColourAxes& colours) {
  FittedSides found = fitted_sides(measurement_, colours, progress_);
  shared_ = std::move(found.shared);
  for (FittedSide& side : found.sides) {
    std::vector<Relief> relief =
        options_.relief ? relief_pyramid(measurement_, side.directions) : plane_pyramid(measurement_.grid());
    sides_.push_back({std::move(side.directions), std::move(relief), {}});
    demand_.push_back({{}, side.energy});
  }
}

void SrbfFitter::find_orders(uint64_t bytes) {
  const size_t most = most_coefficients(measurement_, options_, bytes);
  const LobeOrderOptions order{.most = most,
                               .least = std::pow(kBelow * options_.tolerance, 2.0),
                               .points = search_points(most),
                               .seed = options_.seed,
                               .threads = options_.threads};
  const double share = (1 - kSrbfColors) / static_cast<double>(sides_.size());
  for (size_t s = 0; s < sides_.size(); ++s) {
    const Progress::Span of_side(progress_, kSrbfColors + share * static_cast<double>(s),
                                 kSrbfColors + share * static_cast<double>(s + 1));
    const std::string stage = side_stage(s) + ".order";
    std::optional<LobeOrder> kept = kept_order(checkpoint_, stage);
    if (!kept) {
      const std::vector<SurfacePoint>& points = points_of(s);
      progress_.stage("choosing lobes", kPoints, 1);
      kept = order_lobes(points, order, progress_);
      keep_order(checkpoint_, stage, *kept);
    }
    demand_[s].order = std::move(*kept);
  }
}

/// Warns if memory allows fewer points than usual, because that changes the model.
uint32_t SrbfFitter::search_points(size_t most) {
  const uint32_t usual = LobeOrderOptions().points;
  if (options_.memory == 0) return usual;
  const FitExtent extent = extent_of(measurement_, options_, sides_[0].directions, sides_.size(), most);
  const uint32_t points = search_points_within(options_.memory, extent);
  if (points < usual) {
    warnings_.push_back("within the memory allowed lobes are chosen by " + std::to_string(points) +
                        " places in place of " + std::to_string(usual) +
                        ", which makes another model, as a rule a worse one; " +
                        megabytes(memory_for_all_points(extent)) + " would leave them all");
  }
  return points;
}

/// Reads the points on first use.
const std::vector<SurfacePoint>& SrbfFitter::points_of(size_t number) {
  Side& side = sides_[number];
  if (!side.points.empty()) return side.points;
  progress_.stage("sampling surface points", 0, kPoints);
  const SurfacePointOptions sampling{points_for(measurement_.grid()), kPairs, options_.seed};
  side.points = surface_points(views_, measurement_.grid(), side.directions, side.relief[0], sampling, progress_);
  return side.points;
}

ModelBody SrbfFitter::fit(size_t point) {
  const std::vector<size_t> count = shares_->at(point);
  SrbfBtf btf{measurement_.layout(), measurement_.grid(), options_.companding, axes_, {}, shared_};
  const double share = 1.0 / static_cast<double>(sides_.size());
  for (size_t s = 0; s < sides_.size(); ++s) {
    const Progress::Span of_side(progress_, share * static_cast<double>(s), share * static_cast<double>(s + 1));
    const Side& side = sides_[s];
    const std::string stage = "fit." + std::to_string(point) + "." + side_stage(s);
    const SharedLobes lobes = lobes_of(s, count[s], stage + ".lobes");
    progress_.stage("fitting texels", kLobes, 1);
    const TexelLevelsInput input{measurement_.grid(), side.directions, side.relief, lobes,
                                 options_.companding, options_.threads};
    SrbfSide& fitted = btf.sides.emplace_back(SrbfSide{
        side.directions.view_below, side.directions.light_below, lobes.lobes, lobes.tile_lobes, lobes.lobe, {}, {}});
    solve_levels(views_, input, checkpoint_, stage + ".level.", progress_, fitted);
  }
  return btf;
}

SharedLobes SrbfFitter::lobes_of(size_t side, size_t coefficients, const std::string& stage) {
  const LobeOrder& order = demand_[side].order;
  SharedLobes lobes = chosen_lobes(order, coefficients, options_.seed);
  if (take_kept_lobes(checkpoint_, stage, lobes)) return lobes;
  const std::vector<SurfacePoint>& points = points_of(side);
  progress_.stage("refining lobes", kPoints, kLobes);
  refine_lobes(points, order.share(coefficients), {kRefinements, options_.threads}, lobes, progress_);
  keep_lobes(checkpoint_, stage, lobes);
  return lobes;
}

}  // namespace velour

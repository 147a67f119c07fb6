#include "btf/fit/srbf/srbf_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include "base/error.h"
#include "base/parallel.h"
#include "btf/fit/fit_checkpoint.h"
#include "btf/fit/fitted_sides.h"
#include "btf/fit/relief_pyramid.h"
#include "btf/fit/srbf/lobe_order.h"
#include "btf/fit/srbf/texel_solver.h"
#include "btf/model/srbf_btf.h"

namespace velour {

namespace {

constexpr size_t kMaxCandidates = 3 * SrbfBtf::kMaxLobes;

std::string of_axis(const std::string& name, size_t axis) { return name + "." + std::to_string(axis); }

/// Whether sizes agree and residuals lie within [0, 1].
bool is_sound(const LobeOrder& order) {
  const auto share = order.share(order.axis.size());
  for (size_t a = 0; a < 3; ++a) {
    if (order.candidate[a].size() != share[a]) return false;
  }
  const auto outside = [](double left) { return left < 0 || left > 1; };
  return share[0] > 0 && order.left.size() == order.axis.size() &&
         std::none_of(order.left.begin(), order.left.end(), outside);
}

std::optional<LobeOrder> kept_order(const FitCheckpoint& checkpoint, const std::string& stage) {
  LobeOrder order;
  const auto axis = checkpoint.integers(stage + ".axis", kMaxCandidates, 2);
  const auto left = checkpoint.numbers(stage + ".left", kMaxCandidates);
  if (!axis || !left) return std::nullopt;
  for (const size_t a : *axis) order.axis.push_back(static_cast<uint8_t>(a));
  order.left = *left;
  for (size_t a = 0; a < 3; ++a) {
    auto candidates = checkpoint.integers(of_axis(stage + ".candidate", a), kMaxCandidates, kLobeCandidates - 1);
    if (!candidates) return std::nullopt;
    order.candidate[a] = std::move(*candidates);
  }
  return is_sound(order) ? std::optional(std::move(order)) : std::nullopt;
}

void keep_order(FitCheckpoint& checkpoint, const std::string& stage, const LobeOrder& order) {
  checkpoint.keep_integers(stage + ".axis", {order.axis.begin(), order.axis.end()});
  checkpoint.keep_numbers(stage + ".left", order.left);
  for (size_t a = 0; a < 3; ++a) checkpoint.keep_integers(of_axis(stage + ".candidate", a), order.candidate[a]);
  checkpoint.write();
}

/// Restores refined lobes into `lobes`, which are chosen but not refined; returns false if none are stored.
bool take_kept_lobes(const FitCheckpoint& checkpoint, const std::string& stage, SharedLobes& lobes) {
  const size_t count = lobes.lobes.size();
  const auto vectors =
      checkpoint.matrix(stage + ".vectors", static_cast<Eigen::Index>(count), MultivariateLobe::kNumbers);
  if (!vectors) return false;
  for (size_t j = 0; j < count; ++j) {
    for (int k = 0; k < MultivariateLobe::kNumbers; ++k) {
      lobes.lobes[j][k] = (*vectors)(static_cast<Eigen::Index>(j), k);
    }
  }
  for (size_t a = 1; a < 3; ++a) {
    const auto numbers = checkpoint.integers(of_axis(stage + ".axis", a), count, count - 1);
    if (!numbers) return false;
    lobes.lobe[a].assign(numbers->begin(), numbers->end());
  }
  return true;
}

void keep_lobes(FitCheckpoint& checkpoint, const std::string& stage, const SharedLobes& lobes) {
  RowMatrix vectors(static_cast<Eigen::Index>(lobes.lobes.size()), MultivariateLobe::kNumbers);
  for (size_t j = 0; j < lobes.lobes.size(); ++j) {
    for (int k = 0; k < MultivariateLobe::kNumbers; ++k) {
      vectors(static_cast<Eigen::Index>(j), k) = lobes.lobes[j][k];
    }
  }
  checkpoint.keep(stage + ".vectors", vectors);
  for (size_t a = 1; a < 3; ++a) {
    checkpoint.keep_integers(of_axis(stage + ".axis", a), {lobes.lobe[a].begin(), lobes.lobe[a].end()});
  }
  checkpoint.write();
}

constexpr uint32_t kMaxLobePoints = 400, kMinLobePoints = 24, kPairs = 900;  // for refining lobes
constexpr uint64_t kTexelsOfAPoint = 4;  // small BTFs need fewer points, which saves time
constexpr int kRefinements = 100;
constexpr uint64_t kDefaultSrbfRatio = 400, kDefaultMinLobes = 16;
constexpr size_t kMaxCoefficients = 2 * SrbfBtf::kMaxLobes;
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
  return static_cast<size_t>(std::clamp<uint64_t>(bytes / one, 1, kMaxCoefficients));
}

/// Maximum number of coefficients to consider.
size_t most_coefficients(const BtfMeasurement& measurement, const BtfFitOptions& options, uint64_t bytes) {
  if (options.bytes == 0 && options.tolerance > 0) return kMaxCoefficients;
  return std::min(kBeyond * most_coefficients(bytes, pyramid_texels(measurement.grid())), kMaxCoefficients);
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
  const ColorAxes colors = find_colors(views_, measurement.layout(), checkpoint);
  axes_ = colors.axes;
  not_finite_ = colors.not_finite;
  find_sides(colors);
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

void SrbfFitter::find_sides(const ColorAxes& colors) {
  FittedSides found = fitted_sides(measurement_, colors, progress_);
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
    warnings_.push_back(warning<WarningCode::memory_limits_fit>(
        {{"points", points}, {"usual", usual}, {"memory", memory_for_all_points(extent)}}));
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

namespace {

constexpr size_t kColorPoints = 128, kColorPairs = 500;  // used by the weaker color axes to choose

}  // namespace

SharedLobes chosen_lobes(const LobeOrder& order, size_t coefficients, uint64_t seed) {
  const LobeCandidates candidates = random_candidates(seed);
  const size_t count = order.share(coefficients)[0];
  std::vector<size_t> chosen(order.candidate[0].begin(), order.candidate[0].begin() + static_cast<ptrdiff_t>(count));
  std::sort(chosen.begin(), chosen.end());  // lobes in the tile's frame first
  SharedLobes shared;
  for (const size_t i : chosen) {
    shared.lobes.push_back(candidates.lobes[i]);
    shared.tile_lobes += i < candidates.tile_lobes;
  }
  shared.lobe[0].resize(count);
  std::iota(shared.lobe[0].begin(), shared.lobe[0].end(), uint16_t{0});
  return shared;
}

void refine_lobes(const std::vector<SurfacePoint>& points, const std::array<size_t, 3>& share,
                  const LobeRefinement& options, SharedLobes& lobes, Progress& progress) {
  const RefinementOptions refinement{lobes.tile_lobes, options.steps, options.threads};
  lobes.lobes = refine_lobes(points, std::move(lobes.lobes), refinement, progress);
  const auto columns =
      candidate_columns(points, {lobes.lobes, lobes.tile_lobes}, kColorPoints, kColorPairs, options.threads, progress);
  for (size_t a = 1; a < 3; ++a) {
    const PursuitChoice choice =
        pursue(columns, point_values(points, columns, a), std::min(share[a], share[0]), options.threads, progress);
    for (const size_t i : choice.order) lobes.lobe[a].push_back(static_cast<uint16_t>(i));
  }
}

namespace {

/// Residual sum of squares of a side after `count` coefficients.
double left(const SideDemand& side, size_t count) { return side.energy * side.order.left[count - 1]; }

}  // namespace

uint64_t srbf_side_bytes(uint64_t texels, size_t coefficients, size_t lobes) {
  return texels * (coefficients + sizeof(HalfBits)) + lobes * sizeof(MultivariateLobe) +
         coefficients * (sizeof(uint16_t) + sizeof(ByteScale));
}

SideShares::SideShares(const std::vector<SideDemand>& sides, uint64_t texels) : sides_(sides.size()) {
  std::vector<size_t> count(sides.size(), 1);
  add_point(sides, count, texels);
  for (;;) {
    size_t to = sides.size();
    double most = -1;
    for (size_t s = 0; s < sides.size(); ++s) {
      if (count[s] >= sides[s].order.left.size()) continue;
      const double gain = left(sides[s], count[s]) - left(sides[s], count[s] + 1);
      if (gain > most) {
        most = gain;
        to = s;
      }
    }
    if (to == sides.size()) return;
    ++count[to];
    next_.push_back(to);
    add_point(sides, count, texels);
  }
}

void SideShares::add_point(const std::vector<SideDemand>& sides, const std::vector<size_t>& count, uint64_t texels) {
  double all = 0, rest = 0;
  OrderPoint point;
  for (size_t s = 0; s < sides.size(); ++s) {
    all += sides[s].energy;
    rest += left(sides[s], count[s]);
    point.lobes = std::max(point.lobes, static_cast<int>(count[s]));
    point.parameter_bytes += srbf_side_bytes(texels, count[s], sides[s].order.share(count[s])[0]);
  }
  point.relative_l2 = all > 0 ? std::sqrt(rest / all) : 0.0;
  curve_.points.push_back(point);
}

std::vector<size_t> SideShares::at(size_t point) const {
  std::vector<size_t> count(sides_, 1);
  for (size_t i = 0; i < point; ++i) ++count[next_[i]];
  return count;
}

}  // namespace velour

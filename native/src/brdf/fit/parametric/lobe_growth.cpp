#include "brdf/fit/parametric/lobe_growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "brdf/fit/parametric/solver.h"

namespace velour {

namespace {

// Finds the best additional lobe of the parametric model.

using P = ParametricBrdf;

constexpr size_t kStride = 4;  // the search reads one block of samples in kStride
// Starting coefficient: this share of the best one, to leave room for present lobes; at least this part of the peak.
constexpr double kShare = 0.7, kPeakFloor = 1e-3;
// Number of candidates that are fitted on their own before one is chosen.
constexpr size_t kTried = 3;
constexpr int kTrySteps = 10;
constexpr double kTryLeast = 3e-3;

/// A lobe over all views, before it is fitted.
struct LobeCandidate {
  enum class Follows { nothing, view, mirror };
  Follows follows = Follows::nothing;
  double log_bandwidth = 0;
  std::array<double, 2> tilt{}, stretch{};

  WarpedShape at(LobeSpace space, const Vec3d& wv) const {
    WarpedShape s{space, log_bandwidth, tilt[0], tilt[1], stretch[0], stretch[1]};
    if (follows == Follows::nothing) return s;
    const double sine = std::hypot(wv.x, wv.y), theta = std::atan2(sine, wv.z);
    const double turn = (follows == Follows::view ? theta : -theta) / std::max(sine, 1e-12);
    s.tilt_x = turn * wv.x;
    s.tilt_y = turn * wv.y;
    return s;
  }
};

/// Tilts by `angle` (radians) in several directions: within the plane of incidence if isotropic, otherwise all around.
std::vector<std::array<double, 2>> tilts(double angle, bool isotropic) {
  if (angle == 0) return {{0, 0}};
  if (isotropic) return {{angle, 0}, {-angle, 0}};
  std::vector<std::array<double, 2>> out;
  for (int k = 0; k < 6; ++k) out.push_back({angle * std::cos(k * kPiD / 3), angle * std::sin(k * kPiD / 3)});
  return out;
}

std::vector<LobeCandidate> half_candidates(bool isotropic) {
  using Ab = std::array<double, 2>;
  const auto stretches = isotropic ? std::vector<Ab>{{0, 0}, {0.4, 0}, {-0.4, 0}, {0.9, 0}, {-0.9, 0}}
                                   : std::vector<Ab>{{0, 0}, {0.4, 0}, {-0.4, 0}, {0, 0.4}, {0, -0.4}};
  std::vector<LobeCandidate> out;
  // The fit changes a bandwidth by up to a factor of e per step.
  for (double bandwidth = 1; bandwidth < 1e5; bandwidth *= 2.7) {
    for (const double widths : {0.0, 0.7, 1.5}) {
      for (const auto& t : tilts(widths / std::sqrt(std::max(bandwidth, 4.0)), isotropic)) {
        for (const auto& s : stretches) out.push_back({LobeCandidate::Follows::nothing, std::log(bandwidth), t, s});
      }
    }
  }
  return out;
}

std::vector<LobeCandidate> light_candidates(bool isotropic) {
  std::vector<LobeCandidate> out;
  for (const double bandwidth : {0.05, 1.0, 3.0, 8.0, 20.0, 60.0}) {
    for (const double angle : {0.0, 0.5, 1.0, 1.4}) {
      for (const auto& t : tilts(angle, isotropic)) {
        out.push_back({LobeCandidate::Follows::nothing, std::log(bandwidth), t, {}});
      }
    }
  }
  for (double bandwidth = 1; bandwidth < 1e5; bandwidth *= 2.7) {
    for (const auto follows : {LobeCandidate::Follows::view, LobeCandidate::Follows::mirror}) {
      out.push_back({follows, std::log(bandwidth), {}, {}});
    }
  }
  return out;
}

/// The best coefficients of a candidate at one view, and their gain.
struct Start {
  double coefficient[3] = {0, 0, 0};
  double gain = 0;
};

Start start_at(LobeSpace space, const LobeCandidate& candidate, const FitView& view) {
  const float* residual[3] = {view.residual[0].data(), view.residual[1].data(), view.residual[2].data()};
  const Projection p = project_warped(candidate.at(space, view.wv), view.wv, view.samples, residual, kStride);
  Start start;
  if (p.norm_sq <= 0) return start;
  for (int c = 0; c < 3; ++c) {
    const double moment = std::max(p.moment[c], 0.0);
    start.coefficient[c] = moment / p.norm_sq;
    start.gain += view.scale() * kLuminance[c] * moment * start.coefficient[c];
  }
  return start;
}

/// The control values of the new lobe: [node][parameter].
Eigen::MatrixXd control_values(LobeSpace space, const LobeCandidate& candidate, const std::vector<FitView>& views,
                               const P& model) {
  const ViewSpline spline = model.spline();
  std::vector<Start> starts;
  std::array<double, 3> most{};
  for (const FitView& v : views) {
    starts.push_back(start_at(space, candidate, v));
    for (size_t c = 0; c < 3; ++c) most[c] = std::max(most[c], starts.back().coefficient[c]);
  }
  Eigen::MatrixXd out(spline.node_count(), model.parameter_count());
  const auto through = [&](int parameter, const auto& value) {
    std::vector<double> values;
    for (size_t i = 0; i < views.size(); ++i) values.push_back(value(i));
    out.col(parameter) = spline_through(views, spline, values, model.isotropic && parameter == P::kTiltX)
                             .cwiseMax(lower_bound(parameter))
                             .cwiseMin(upper_bound(parameter));
  };
  through(P::kLogBandwidth, [&](size_t) { return candidate.log_bandwidth; });
  through(P::kTiltX, [&](size_t i) { return candidate.at(space, views[i].wv).tilt_x; });
  through(P::kStretchA, [&](size_t) { return candidate.stretch[0]; });
  if (!model.isotropic) {
    through(P::kTiltY, [&](size_t i) { return candidate.at(space, views[i].wv).tilt_y; });
    through(P::kStretchB, [&](size_t) { return candidate.stretch[1]; });
  }
  for (int c = 0; c < 3; ++c) {
    through(P::kLogRed + c, [&](size_t i) {
      const double floor = std::max(kPeakFloor * most[static_cast<size_t>(c)], 1e-9);
      return std::log(std::max(kShare * starts[i].coefficient[c], floor));
    });
  }
  return out;
}

/// The model of `lobes` with a single lobe of the given space and control values.
FitLobes alone(const FitLobes& lobes, LobeSpace space, const Eigen::MatrixXd& control) {
  FitLobes out = lobes;
  out.model.space.assign(1, space);
  out.x = control.reshaped<Eigen::RowMajor>();
  return out;
}

/// The candidates that gain most, best first, at most one for each bandwidth and `follows`.
std::vector<size_t> most_promising(const std::vector<LobeCandidate>& all, const std::vector<double>& gain) {
  std::vector<size_t> best;
  for (size_t i = 0; i < all.size(); ++i) {
    if (!(gain[i] > 0)) continue;
    const auto same = std::find_if(best.begin(), best.end(), [&](size_t b) {
      return all[b].log_bandwidth == all[i].log_bandwidth && all[b].follows == all[i].follows;
    });
    if (same == best.end())
      best.push_back(i);
    else if (gain[i] > gain[*same])
      *same = i;
  }
  std::stable_sort(best.begin(), best.end(), [&](size_t a, size_t b) { return gain[a] > gain[b]; });
  best.resize(std::min(best.size(), kTried));
  return best;
}

/// `lobes` with one more lobe in `space`. A list of shapes, fixed or following the view or its mirror direction, is
/// ranked by the gain of each over all views with its best coefficient at each. The few best are fitted separately to
/// the residual of `lobes`, and the best of these is added. The problem must hold the residuals of `lobes`. Nothing if
/// no shape gains anything.
std::optional<FitLobes> with_best_lobe(const FitProblem& problem, const FitLobes& lobes, LobeSpace space) {
  const std::vector<LobeCandidate> all =
      space == LobeSpace::half ? half_candidates(lobes.model.isotropic) : light_candidates(lobes.model.isotropic);
  std::vector<double> gain(all.size(), 0.0);
  parallel_pieces(all.size(), problem.threads(), problem.progress(), [&](size_t i) {
    for (const FitView& v : problem.views()) gain[i] += start_at(space, all[i], v).gain;
  });
  const std::vector<size_t> tried = most_promising(all, gain);
  std::vector<FitLobes> trials(tried.size());
  parallel_pieces(tried.size(), problem.threads(), problem.progress(), [&](size_t t) {
    FitProblem remainder = problem.remainder();
    trials[t] = alone(lobes, space, control_values(space, all[tried[t]], problem.views(), lobes.model));
    refine(remainder, trials[t], kTrySteps, kTryLeast);
  });
  const auto best = std::min_element(trials.begin(), trials.end(), costs_less);
  if (best == trials.end()) return std::nullopt;
  return joined(lobes, *best);
}

using Index = Eigen::Index;

// Every trial takes the first steps; only the best takes the remaining ones.
constexpr int kFirstSteps = 3, kGrowthSteps = 20;
constexpr double kGrowthTolerance = 3e-3;

/// Trials after their first steps: a new lobe in each of the `spaces` and, if samples are dense, a split lobe.
std::vector<FitLobes> first_steps(const FitProblem& problem, const FitLobes& lobes, std::span<const LobeSpace> spaces) {
  std::vector<std::optional<FitLobes>> found(spaces.size() + (problem.dense() ? 1 : 0));
  parallel_pieces(found.size(), problem.threads(), problem.progress(), [&](size_t i) {
    found[i] = i < spaces.size() ? with_best_lobe(problem, lobes, spaces[i]) : with_split_lobe(problem, lobes);
    if (!found[i]) return;
    FitProblem own = problem;
    refine(own, *found[i], kFirstSteps, kGrowthTolerance);
  });
  std::vector<FitLobes> out;
  for (std::optional<FitLobes>& trial : found) {
    if (trial) out.push_back(std::move(*trial));
  }
  return out;
}

}  // namespace

bool add_lobe(FitProblem& problem, FitLobes& lobes, std::span<const LobeSpace> spaces, Search search) {
  problem.evaluate(lobes.model, lobes.x);  // the search reads its residuals
  std::vector<FitLobes> trials = first_steps(search == Search::quick ? problem.thinned() : problem, lobes, spaces);
  const auto best = std::min_element(trials.begin(), trials.end(), costs_less);
  if (best != trials.end()) refine(problem, *best, kGrowthSteps - kFirstSteps, kGrowthTolerance);
  const bool better = best != trials.end() && best->cost < lobes.cost;
  if (better) lobes = std::move(*best);
  problem.evaluate(lobes.model, lobes.x);
  return better;
}

bool exchange_lobe(FitProblem& problem, FitLobes& lobes) {
  if (lobes.model.lobe_count() < 2) return false;
  FitLobes fewer;
  for (Index j = 0; j < lobes.model.lobe_count(); ++j) {
    FitLobes trial = without_lobe(lobes, j);
    trial.cost = problem.evaluate(trial.model, trial.x);
    if (j == 0 || trial.cost < fewer.cost) fewer = std::move(trial);
  }
  refine(problem, fewer, kGrowthSteps, kGrowthTolerance);
  constexpr LobeSpace kBoth[] = {LobeSpace::half, LobeSpace::light};
  const bool better = add_lobe(problem, fewer, kBoth) && fewer.cost < lobes.cost;
  if (better) lobes = std::move(fewer);
  problem.evaluate(lobes.model, lobes.x);
  return better;
}

namespace {

/// Number of rows of the control values [node][parameter][lobe], each of all lobes.
Index rows_of(const ParametricBrdf& model) {
  return static_cast<Index>(model.spline().node_count()) * model.parameter_count();
}

}  // namespace

FitLobes without_lobe(const FitLobes& lobes, Index lobe) {
  FitLobes out = lobes;
  out.model.space.erase(out.model.space.begin() + lobe);
  const Index rows = rows_of(lobes.model), count = lobes.model.lobe_count();
  out.x.resize(rows * (count - 1));
  for (Index r = 0; r < rows; ++r) {
    out.x.segment(r * (count - 1), lobe) = lobes.x.segment(r * count, lobe);
    out.x.segment(r * (count - 1) + lobe, count - 1 - lobe) = lobes.x.segment(r * count + lobe + 1, count - 1 - lobe);
  }
  return out;
}

FitLobes only_lobe(const FitLobes& lobes, Index lobe) {
  FitLobes out = lobes;
  out.model.space.assign(1, lobes.model.space[static_cast<size_t>(lobe)]);
  const Index rows = rows_of(lobes.model), count = lobes.model.lobe_count();
  out.x.resize(rows);
  for (Index r = 0; r < rows; ++r) out.x[r] = lobes.x[r * count + lobe];
  return out;
}

FitLobes joined(const FitLobes& lobes, const FitLobes& more) {
  FitLobes out = lobes;
  out.model.space.insert(out.model.space.end(), more.model.space.begin(), more.model.space.end());
  const Index rows = rows_of(lobes.model), first = lobes.model.lobe_count(), second = more.model.lobe_count();
  out.x.resize(rows * (first + second));
  for (Index r = 0; r < rows; ++r) {
    out.x.segment(r * (first + second), first) = lobes.x.segment(r * first, first);
    out.x.segment(r * (first + second) + first, second) = more.x.segment(r * second, second);
  }
  return out;
}

namespace {

// Offsets of the halves from their lobe: of the log bandwidth, and of the center in lobe widths.
constexpr double kNarrower = 0.5, kApart = 0.3;
// The halves of all lobes are refined by one step, those of the kKept best by more.
constexpr size_t kKept = 3;
constexpr int kSplitSteps = 3;
constexpr double kSplitTolerance = 1e-3;

/// The half on `side` (1 or -1) of `lobe`, which has a single lobe.
FitLobes half_of(const FitLobes& lobe, double side) {
  FitLobes half = lobe;
  const Index parameters = lobe.model.parameter_count();
  for (Index node = 0; node < lobe.x.size(); node += parameters) {
    const double width = std::exp(-0.5 * std::max(lobe.x[node + P::kLogBandwidth], 0.0));
    half.x[node + P::kLogBandwidth] += side * kNarrower;
    half.x[node + P::kTiltX] += side * kApart * width;
    for (const int color : {P::kLogRed, P::kLogGreen, P::kLogBlue}) half.x[node + color] -= std::log(2.0);
    for (int p = 0; p < parameters; ++p) {
      half.x[node + p] = std::clamp(half.x[node + p], lower_bound(p), upper_bound(p));
    }
  }
  return half;
}

/// The halves of a lobe, fitted to the residual of the others.
struct Split {
  Index lobe;
  FitLobes halves;

  void refine_beside(const FitProblem& problem, const FitLobes& one, int steps) {
    FitProblem left = problem.remainder_with(one.model, one.x);
    refine(left, halves, steps, kSplitTolerance);
  }
};

}  // namespace

std::optional<FitLobes> with_split_lobe(const FitProblem& problem, const FitLobes& lobes) {
  const auto cheaper = [](const Split& a, const Split& b) { return costs_less(a.halves, b.halves); };
  std::vector<Split> splits;
  for (Index j = 0; j < lobes.model.lobe_count(); ++j) {
    const FitLobes one = only_lobe(lobes, j);
    splits.push_back({j, joined(half_of(one, 1), half_of(one, -1))});
  }
  const auto refine_all = [&](int steps) {
    parallel_pieces(splits.size(), problem.threads(), problem.progress(),
                    [&](size_t s) { splits[s].refine_beside(problem, only_lobe(lobes, splits[s].lobe), steps); });
  };
  refine_all(1);
  std::stable_sort(splits.begin(), splits.end(), cheaper);
  splits.resize(std::min(splits.size(), kKept), {0, lobes});
  refine_all(kSplitSteps);
  const auto best = std::min_element(splits.begin(), splits.end(), cheaper);
  if (best == splits.end()) return std::nullopt;
  return joined(without_lobe(lobes, best->lobe), best->halves);
}

}  // namespace velour

#include "brdf/fit/parametric/growth.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "base/parallel.h"
#include "brdf/fit/fit_report.h"
#include "brdf/fit/parametric/lobe_growth.h"

namespace velour {
namespace {

using Index = Eigen::Index;

// Views are fitted more tightly than required, to leave room for the views between them and for the folding error.
constexpr double kViewGoalShare = 0.8;
constexpr int kFirstLobes = 4;
constexpr int kPolishSteps = 80, kPolishRounds = 4, kRoundSteps = 8;
// Maximum number of lobe exchanges in a model of few lobes before it grows further.
constexpr int kExchanges = 4;
constexpr double kPolishLeast = 3e-4;

// If a lobe lowers the cost by less than this share, more lobes hardly help.
constexpr double kMinGain = 0.01;
// Number of such lobes in a row that ends the growth: a single one may enable the next.
constexpr int kIdleLobes = 2;
// That share once growth by view errors has ended and only the picture error asks for more lobes.
constexpr double kMinPictureGain = 0.03;

OrderPoint order_point(const FitProblem& problem, const FitLobes& lobes) {
  OrderPoint point;
  point.lobes = lobes.model.lobe_count();
  point.parameter_bytes =
      ParametricBrdf::parameter_bytes(static_cast<uint64_t>(lobes.x.size()), lobes.model.space.size());
  double weight = 0;
  for (const FitView& v : problem.views()) {
    if (v.guide) continue;
    const double error = reported_error(problem.views(), v);
    point.worst = std::max(point.worst, kViewGoalShare * error / v.goal);
    point.relative_l2 += v.wv.z * error;
    weight += v.wv.z;
  }
  point.relative_l2 /= std::max(weight, 1e-12);
  return point;
}

/// Raises the weights of views that are far from their goal.
void reweight(FitProblem& problem) {
  double square = 0, mean = 0, count = 0;
  for (const FitView& v : problem.views()) {
    if (!v.guide) square += (v.error / v.goal) * (v.error / v.goal), ++count;
  }
  const double middle = std::sqrt(square / count);
  if (!(middle > 0)) return;
  for (FitView& v : problem.views()) {
    if (v.guide) continue;
    v.weight *= std::clamp(v.error / v.goal / middle, 0.6, 1.8);
    mean += v.weight / count;
  }
  for (FitView& v : problem.views()) {
    if (!v.guide) v.weight /= mean;
  }
  problem.weigh_for_pictures();
}

bool is_color(const ParametricBrdf& model, Index i) {
  const int p = static_cast<int>(i / model.lobe_count()) % model.parameter_count();
  return p >= ParametricBrdf::kLogRed && p <= ParametricBrdf::kLogBlue;
}

double half(double value) { return glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(value))); }

/// Rounds to half floats, as in the file: shapes first, so that the colors can compensate.
void round_to_half(FitProblem& problem, FitLobes& lobes) {
  for (const bool colors : {false, true}) {
    for (Index i = 0; i < lobes.x.size(); ++i) {
      if (is_color(lobes.model, i) == colors) lobes.x[i] = half(lobes.x[i]);
    }
    if (!colors) refine(problem, lobes, 4, 1e-3, Free::colors);
  }
  lobes.cost = problem.evaluate(lobes.model, lobes.x);
}

/// Mean over the views, weighted by the projected area, cos(theta_v).
double mean_picture_error(const FitProblem& problem) {
  double sum = 0, weight = 0;
  for (const FitView& v : problem.views()) sum += v.wv.z * v.picture_error, weight += v.wv.z;
  return sum / std::max(weight, 1e-12);
}

/// Adds the picture error to the cost, and lobes as long as they lower it enough.
void grow_for_pictures(FitProblem& problem, FitLobes& lobes, int most, std::vector<OrderPoint>& points) {
  constexpr LobeSpace kBoth[] = {LobeSpace::half, LobeSpace::light};
  problem.weigh_for_pictures();
  refine(problem, lobes, kPolishSteps, kPolishLeast);
  while (lobes.model.lobe_count() < most && mean_picture_error(problem) > kPictureGoal) {
    const double before = lobes.cost;
    if (!add_lobe(problem, lobes, kBoth)) return;
    points.push_back(order_point(problem, lobes));
    if (lobes.cost > (1 - kMinPictureGain) * before) return;
  }
}

/// Final refinement for a number of lobes: reweights views that are far from their goal, then rounds.
void polish(FitProblem& problem, FitLobes& lobes) {
  refine(problem, lobes, kPolishSteps, kPolishLeast);
  for (int round = 0; round < kPolishRounds; ++round) {
    reweight(problem);
    refine(problem, lobes, kRoundSteps, kPolishLeast);
  }
  round_to_half(problem, lobes);
}

void record_errors(const FitProblem& problem, GrowthResult& fit) {
  fit.views.clear();
  fit.error.clear();
  for (const FitView& v : problem.views()) {
    if (v.guide) continue;
    fit.views.push_back(v.wv);
    fit.error.push_back(reported_error(problem.views(), v));
  }
}

}  // namespace

class LobeGrowth::Growth {
 public:
  Growth(FitProblem& problem, const GrowthOptions& options, Progress& progress)
      : problem_(problem), options_(options), progress_(progress) {
    lobes_.model.isotropic = options.isotropic;
    lobes_.model.cells = options.cells;
    lobes_.model.views = options.views;
    lobes_.cost = problem.evaluate(lobes_.model, lobes_.x);
  }

  /// Starts with lobes, which are refined first.
  void start_with(FitLobes lobes) {
    lobes_ = std::move(lobes);
    refine(problem_, lobes_, kPolishSteps, kPolishLeast);
    points_.push_back(order_point(problem_, lobes_));
    done_ = good_enough();
  }

  /// Adds lobes in `spaces` until there are `most`, all views meet their goals, or more lobes hardly help.
  void grow(std::span<const LobeSpace> spaces, int most) {
    problem_.evaluate(lobes_.model, lobes_.x);
    while (!done_ && lobes_.model.lobe_count() < most) {
      const double before = lobes_.cost;
      done_ = !add_lobe(problem_, lobes_, spaces, search_);
      if (done_ && search_ == Search::quick && is_far()) {
        search_ = Search::thorough;
        done_ = !add_lobe(problem_, lobes_, spaces, search_);
      }
      if (done_) return;
      // If the lobe gains next to nothing, another may be in the wrong place.
      if (lobes_.cost > (1 - kMinGain) * before) exchange_lobe(problem_, lobes_);
      points_.push_back(order_point(problem_, lobes_));
      progress_.update(static_cast<double>(lobes_.model.lobe_count()) / options_.max_lobes);
      idle_ = lobes_.cost > (1 - kMinGain) * before ? idle_ + 1 : 0;
      done_ = good_enough() || idle_ >= kIdleLobes;
    }
  }

  /// Exchanges lobes while that helps: greedy growth may have misplaced the first ones beyond repair by later ones.
  void put_in_order() {
    for (int k = 0; k < kExchanges && problem_.dense() && !points_.empty() && !good_enough(); ++k) {
      const double before = lobes_.cost;
      if (!exchange_lobe(problem_, lobes_)) return;
      points_.back() = order_point(problem_, lobes_);
      if (lobes_.cost > (1 - kMinGain) * before) return;
      done_ = good_enough();
      idle_ = 0;
    }
  }

  const FitLobes& lobes() const { return lobes_; }
  const std::vector<OrderPoint>& points() const { return points_; }

 private:
  bool good_enough() const { return points_.back().worst <= kViewGoalShare; }
  /// Whether the views miss their goals on average.
  bool is_far() const {
    return problem_.dense() && (points_.empty() || points_.back().relative_l2 > kViewGoalShare * options_.tolerance);
  }

  FitProblem& problem_;
  const GrowthOptions& options_;
  Progress& progress_;
  FitLobes lobes_;
  std::vector<OrderPoint> points_;
  Search search_ = Search::quick;
  int idle_ = 0;       // lobes in a row that gained next to nothing
  bool done_ = false;  // no more lobes are wanted
};

namespace {

/// Allowed error of a symmetric model against the folded values of a view, such that its error against the measurement
/// is `tolerance` or, if larger, the difference of mirror images: sqrt(2) times `fold` (brdf/fit/error/compare.h). At
/// most `tolerance`.
double beside_fold(double tolerance, double fold) {
  const double allowed = std::max(tolerance, std::sqrt(2.0) * fold);
  return std::min(tolerance, std::sqrt(allowed * allowed - fold * fold));
}

FitProblem problem_of(const std::vector<MeasuredSlice>& slices, const GrowthOptions& options,
                      const Progress& progress) {
  const auto goal = [&options](const MeasuredSlice& slice) {
    const double theta_v = std::acos(std::clamp(Vec3d(slice.wv).z, -1.0, 1.0));
    return kViewGoalShare * beside_fold(tolerance_at(options.tolerance, theta_v), slice.fold);
  };
  const ViewSpline spline(options.isotropic, options.cells, options.views);
  return {slices, spline, goal, options.seen_evenly, options.threads, progress};
}

}  // namespace

/// Greedy growth may start in the wrong space and never recover, so the first lobes are also tried in half space alone.
struct LobeGrowth::State {
  GrowthOptions options;
  FitProblem problem, problem_of_half;
  Growth both, half;

  State(const std::vector<MeasuredSlice>& slices, const GrowthOptions& wanted, Progress& progress)
      : options(wanted),
        problem(problem_of(slices, options, progress)),
        problem_of_half(problem),
        both(problem, options, progress),
        half(problem_of_half, options, progress) {}

  GrowthResult fit(int most);
  /// Continues from the lobes of `coarse`, in place of a start with none.
  GrowthResult finer(const ParametricBrdf& coarse);

 private:
  const Growth& grown(int most) {
    constexpr LobeSpace kBoth[] = {LobeSpace::half, LobeSpace::light}, kHalf[] = {LobeSpace::half};
    const int first = std::min(kFirstLobes, most);
    if (!begun) {
      // Not for smaller models: larger ones that share this growth would start with other lobes than on their own.
      begun = first == kFirstLobes;
      parallel_pieces(2, options.threads, problem.progress(), [&](size_t i) {
        Growth& growth = i == 0 ? both : half;
        growth.grow(i == 0 ? std::span<const LobeSpace>(kBoth) : kHalf, first);
        if (begun) growth.put_in_order();
      });
      by_half = half.lobes().cost < both.lobes().cost;
    }
    Growth& best = by_half ? half : both;
    best.grow(kBoth, most);
    return best;
  }

  bool begun = false, by_half = false;
};

LobeGrowth::LobeGrowth(const std::vector<MeasuredSlice>& slices, const GrowthOptions& options, Progress& progress)
    : state_(std::make_unique<State>(slices, options, progress)) {}
LobeGrowth::~LobeGrowth() = default;

GrowthResult LobeGrowth::fit(int most) {
  GrowthResult fit;
  in_one_arena(state_->options.threads, [&] { fit = state_->fit(most); });
  return fit;
}

GrowthResult LobeGrowth::finer(const ParametricBrdf& coarse) {
  GrowthResult fit;
  in_one_arena(state_->options.threads, [&] { fit = state_->finer(coarse); });
  return fit;
}

namespace {

/// The result for the lobes that have been grown: pictures, refinement, rounding, errors. `own` changes its weights.
GrowthResult finished(FitProblem own, FitLobes lobes, const std::vector<OrderPoint>& points, int most) {
  GrowthResult fit;
  fit.order.points = points;
  own.evaluate(lobes.model, lobes.x);
  if (lobes.model.lobe_count() > 0) {
    grow_for_pictures(own, lobes, most, fit.order.points);
    polish(own, lobes);
    // The final model replaces the last point of the growth.
    fit.order.points.back() = order_point(own, lobes);
    fit.order.chosen = fit.order.points.size() - 1;
  }
  fit.brdf = lobes.model;
  for (const double v : lobes.x) fit.brdf.control.push_back(static_cast<float>(v));
  record_errors(own, fit);
  return fit;
}

/// The lobes of `brdf` on a spline twice as fine, which can represent them.
FitLobes halved(const ParametricBrdf& brdf) {
  FitLobes out;
  out.model = brdf;
  out.model.control.clear();
  out.model.cells = 2 * brdf.cells;
  const ViewSpline spline = brdf.spline();
  const int nodes = out.model.spline().node_count();
  out.x.resize(static_cast<Index>(out.model.index(nodes, 0, 0)));
  for (int k = 0; k < brdf.parameter_count(); ++k) {
    for (int j = 0; j < brdf.lobe_count(); ++j) {
      std::vector<double> values;
      for (int node = 0; node < spline.node_count(); ++node) {
        values.push_back(static_cast<double>(brdf.control[brdf.index(node, k, j)]));
      }
      const std::vector<double> finer = spline.halved(values, brdf.isotropic && k == ParametricBrdf::kTiltX);
      for (int node = 0; node < nodes; ++node) {
        out.x[static_cast<Index>(out.model.index(node, k, j))] = finer[static_cast<size_t>(node)];
      }
    }
  }
  return out;
}

}  // namespace

GrowthResult LobeGrowth::State::fit(int most) {
  const Growth& growth = grown(most);
  return finished(problem, growth.lobes(), growth.points(), most);
}

GrowthResult LobeGrowth::State::finer(const ParametricBrdf& coarse) {
  constexpr LobeSpace kBoth[] = {LobeSpace::half, LobeSpace::light};
  both.start_with(halved(coarse));
  both.grow(kBoth, options.max_lobes);
  return finished(problem, both.lobes(), both.points(), options.max_lobes);
}

GrowthResult grow_finer(const std::vector<MeasuredSlice>& slices, GrowthOptions options, const ParametricBrdf& coarse,
                        Progress& progress) {
  options.cells = 2 * coarse.cells;
  return LobeGrowth(slices, options, progress).finer(coarse);
}

GrowthResult grow_lobes(const std::vector<MeasuredSlice>& slices, const GrowthOptions& options, Progress& progress) {
  return LobeGrowth(slices, options, progress).fit(options.max_lobes);
}

void judge_again(const std::vector<MeasuredSlice>& slices, GrowthOptions options, GrowthResult& fit,
                 const Progress& progress) {
  options.cells = fit.brdf.cells;
  options.views = fit.brdf.views;
  FitProblem problem = problem_of(slices, options, progress);
  for (FitView& v : problem.views()) v.error = error_of(fit.brdf, v);
  record_errors(problem, fit);
}

}  // namespace velour

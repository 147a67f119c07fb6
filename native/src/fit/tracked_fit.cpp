#include "fit/tracked_fit.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "fit/fit_report.h"
#include "fit/lobe_growth.h"
#include "job/parallel.h"

namespace velour {
namespace {

using Index = Eigen::Index;

// Views are fitted a little tighter than asked, for those between them and for what the fold has hidden.
constexpr double kViewGoalShare = 0.8;
constexpr int kFirstLobes = 4;
constexpr int kPolishSteps = 80, kPolishRounds = 4, kRoundSteps = 8;
// A model of few lobes is put in order before it grows on: so often lobes change places.
constexpr int kExchanges = 4;
constexpr double kPolishLeast = 3e-4;

// A lobe that lowers the cost by less than this says that lobes are not what is missing.
constexpr double kLeastGain = 0.01;
// So many of them in turn: one alone may be what the next needs.
constexpr int kIdleLobes = 2;
// The same where the growth by the error is over and only pictures ask for more.
constexpr double kLeastPictureGain = 0.03;

OrderPoint order_point(const TrackedProblem& problem, const TrackedLobes& lobes) {
  OrderPoint point;
  point.lobes = lobes.model.lobe_count();
  point.parameter_bytes =
      ParametricBrdf::parameter_bytes(static_cast<uint64_t>(lobes.x.size()), lobes.model.space.size());
  double weight = 0;
  for (const TrackedView& v : problem.views()) {
    if (v.guide) continue;
    const double error = reported_error(problem.views(), v);
    point.worst = std::max(point.worst, kViewGoalShare * error / v.goal);
    point.relative_l2 += v.wv.z * error;
    weight += v.wv.z;
  }
  point.relative_l2 /= std::max(weight, 1e-12);
  return point;
}

/// Views that are far from their goal count more from now on.
void reweight(TrackedProblem& problem) {
  double square = 0, mean = 0, count = 0;
  for (const TrackedView& v : problem.views()) {
    if (!v.guide) square += (v.error / v.goal) * (v.error / v.goal), ++count;
  }
  const double middle = std::sqrt(square / count);
  if (!(middle > 0)) return;
  for (TrackedView& v : problem.views()) {
    if (v.guide) continue;
    v.weight *= std::clamp(v.error / v.goal / middle, 0.6, 1.8);
    mean += v.weight / count;
  }
  for (TrackedView& v : problem.views()) {
    if (!v.guide) v.weight /= mean;
  }
  problem.weigh_for_pictures();
}

bool is_color(const ParametricBrdf& model, Index i) {
  const int p = static_cast<int>(i / model.lobe_count()) % model.parameter_count();
  return p >= ParametricBrdf::kLogRed && p <= ParametricBrdf::kLogBlue;
}

double half(double value) { return glm::unpackHalf1x16(glm::packHalf1x16(static_cast<float>(value))); }

/// Rounds to what the file holds: shapes first, so that the colours can make up for it.
void round_to_half(TrackedProblem& problem, TrackedLobes& lobes) {
  for (const bool colors : {false, true}) {
    for (Index i = 0; i < lobes.x.size(); ++i) {
      if (is_color(lobes.model, i) == colors) lobes.x[i] = half(lobes.x[i]);
    }
    if (!colors) refine(problem, lobes, 4, 1e-3, Free::colors);
  }
  lobes.cost = problem.evaluate(lobes.model, lobes.x);
}

/// Mean over the views, each by the area that faces its viewer.
double mean_picture_error(const TrackedProblem& problem) {
  double sum = 0, weight = 0;
  for (const TrackedView& v : problem.views()) sum += v.wv.z * v.picture_error, weight += v.wv.z;
  return sum / std::max(weight, 1e-12);
}

/// What pictures show counts from now on, with more lobes while they gain much there.
void grow_for_pictures(TrackedProblem& problem, TrackedLobes& lobes, int most, std::vector<OrderPoint>& points) {
  constexpr LobeSpace kBoth[] = {LobeSpace::half, LobeSpace::light};
  problem.weigh_for_pictures();
  refine(problem, lobes, kPolishSteps, kPolishLeast);
  while (lobes.model.lobe_count() < most && mean_picture_error(problem) > kPictureGoal) {
    const double before = lobes.cost;
    if (!add_lobe(problem, lobes, kBoth)) return;
    points.push_back(order_point(problem, lobes));
    if (lobes.cost > (1 - kLeastPictureGain) * before) return;
  }
}

/// The last word on a number of lobes: the views far from their goal brought nearer, then rounded.
void polish(TrackedProblem& problem, TrackedLobes& lobes) {
  refine(problem, lobes, kPolishSteps, kPolishLeast);
  for (int round = 0; round < kPolishRounds; ++round) {
    reweight(problem);
    refine(problem, lobes, kRoundSteps, kPolishLeast);
  }
  round_to_half(problem, lobes);
}

void record_errors(const TrackedProblem& problem, TrackedFit& fit) {
  fit.views.clear();
  fit.error.clear();
  for (const TrackedView& v : problem.views()) {
    if (v.guide) continue;
    fit.views.push_back(v.wv);
    fit.error.push_back(reported_error(problem.views(), v));
  }
}

}  // namespace

class TrackedGrowth::Growth {
 public:
  Growth(TrackedProblem& problem, const TrackedFitOptions& options, Progress& progress)
      : problem_(problem), options_(options), progress_(progress) {
    lobes_.model.isotropic = options.isotropic;
    lobes_.model.cells = options.cells;
    lobes_.model.views = options.views;
    lobes_.cost = problem.evaluate(lobes_.model, lobes_.x);
  }

  /// Adds lobes of `spaces` until there are `most`, or until no view asks for more.
  void grow(std::span<const LobeSpace> spaces, int most) {
    problem_.evaluate(lobes_.model, lobes_.x);
    while (!done_ && lobes_.model.lobe_count() < most) {
      const double before = lobes_.cost;
      done_ = !add_lobe(problem_, lobes_, spaces);
      if (done_) return;
      // A lobe that gains next to nothing: perhaps another stands in the wrong place.
      if (lobes_.cost > (1 - kLeastGain) * before) exchange_lobe(problem_, lobes_);
      points_.push_back(order_point(problem_, lobes_));
      progress_.update(static_cast<double>(lobes_.model.lobe_count()) / options_.max_lobes);
      idle_ = lobes_.cost > (1 - kLeastGain) * before ? idle_ + 1 : 0;
      done_ = good_enough() || idle_ >= kIdleLobes;
    }
  }

  /// Lobes change places while that gains something: greed may have put the first ones where later ones cannot mend it.
  void put_in_order() {
    for (int k = 0; k < kExchanges && problem_.dense() && !points_.empty() && !good_enough(); ++k) {
      const double before = lobes_.cost;
      if (!exchange_lobe(problem_, lobes_)) return;
      points_.back() = order_point(problem_, lobes_);
      if (lobes_.cost > (1 - kLeastGain) * before) return;
      done_ = good_enough();
      idle_ = 0;
    }
  }

  const TrackedLobes& lobes() const { return lobes_; }
  const std::vector<OrderPoint>& points() const { return points_; }

 private:
  bool good_enough() const { return points_.back().worst <= kViewGoalShare; }

  TrackedProblem& problem_;
  const TrackedFitOptions& options_;
  Progress& progress_;
  TrackedLobes lobes_;
  std::vector<OrderPoint> points_;
  int idle_ = 0;       // lobes in turn that gained next to nothing
  bool done_ = false;  // no more lobes are wanted
};

namespace {

/// What a symmetric model may err by against the folded values of a view, so that against what was measured it errs by
/// `tolerance`, or, where that is more, by what mirror images differ by: sqrt(2) times `fold` (fit/noise.h). Never more
/// than `tolerance`.
double beside_fold(double tolerance, double fold) {
  const double allowed = std::max(tolerance, std::sqrt(2.0) * fold);
  return std::min(tolerance, std::sqrt(allowed * allowed - fold * fold));
}

TrackedProblem problem_of(const std::vector<MeasuredSlice>& slices, const TrackedFitOptions& options,
                          const Progress& progress) {
  const auto goal = [&options](const MeasuredSlice& slice) {
    const double theta_v = std::acos(std::clamp(Vec3d(slice.wv).z, -1.0, 1.0));
    return kViewGoalShare * beside_fold(tolerance_at(options.tolerance, theta_v), slice.fold);
  };
  const ViewSpline spline(options.isotropic, options.cells, options.views);
  return {slices, spline, goal, options.seen_evenly, options.threads, progress};
}

}  // namespace

/// Greed may begin in the wrong space and never mend it, so the first lobes are tried in half space alone as well.
struct TrackedGrowth::State {
  TrackedFitOptions options;
  TrackedProblem problem, problem_of_half;
  Growth both, half;

  State(const std::vector<MeasuredSlice>& slices, const TrackedFitOptions& wanted, Progress& progress)
      : options(wanted),
        problem(problem_of(slices, options, progress)),
        problem_of_half(problem),
        both(problem, options, progress),
        half(problem_of_half, options, progress) {}

  TrackedFit fit(int most);

 private:
  const Growth& grown(int most) {
    constexpr LobeSpace kBoth[] = {LobeSpace::half, LobeSpace::light}, kHalf[] = {LobeSpace::half};
    const int first = std::min(kFirstLobes, most);
    if (!begun) {
      // Not the lobes of smaller models: larger ones that share this growth would begin with others than on their own.
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

TrackedGrowth::TrackedGrowth(const std::vector<MeasuredSlice>& slices, const TrackedFitOptions& options,
                             Progress& progress)
    : state_(std::make_unique<State>(slices, options, progress)) {}
TrackedGrowth::~TrackedGrowth() = default;

TrackedFit TrackedGrowth::fit(int most) {
  TrackedFit fit;
  in_one_arena(state_->options.threads, [&] { fit = state_->fit(most); });
  return fit;
}

TrackedFit TrackedGrowth::State::fit(int most) {
  const Growth& growth = grown(most);
  TrackedLobes lobes = growth.lobes();
  TrackedFit fit;
  fit.order.points = growth.points();
  TrackedProblem own = problem;  // weights change from here on
  own.evaluate(lobes.model, lobes.x);
  if (lobes.model.lobe_count() > 0) {
    grow_for_pictures(own, lobes, most, fit.order.points);
    polish(own, lobes);
    // What the growth ends with takes the place of its last point.
    fit.order.points.back() = order_point(own, lobes);
    fit.order.chosen = fit.order.points.size() - 1;
  }
  fit.brdf = lobes.model;
  for (const double v : lobes.x) fit.brdf.control.push_back(static_cast<float>(v));
  record_errors(own, fit);
  return fit;
}

TrackedFit fit_tracked(const std::vector<MeasuredSlice>& slices, const TrackedFitOptions& options, Progress& progress) {
  return TrackedGrowth(slices, options, progress).fit(options.max_lobes);
}

void judge_again(const std::vector<MeasuredSlice>& slices, TrackedFitOptions options, TrackedFit& fit,
                 const Progress& progress) {
  options.cells = fit.brdf.cells;
  options.views = fit.brdf.views;
  TrackedProblem problem = problem_of(slices, options, progress);
  for (TrackedView& v : problem.views()) v.error = error_of(fit.brdf, v);
  record_errors(problem, fit);
}

}  // namespace velour

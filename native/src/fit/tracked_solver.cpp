#include "fit/tracked_solver.h"

#include <algorithm>
#include <cmath>

namespace velour {
namespace {

using Index = Eigen::Index;
using P = ParametricBrdf;

constexpr double kFirstDamping = 1e-3, kLeastDamping = 1e-6;
constexpr double kFastestFall = 0.2, kSlowestRise = 2;  // bounds of the factor of the damping after an accepted step
constexpr int kTrials = 6;
constexpr double kMaxStep = 1;  // maximum change of a control value: a factor of e, or a radian

int parameter_of(const P& model, Index i) { return static_cast<int>(i / model.lobe_count()) % model.parameter_count(); }

Eigen::VectorXd stepped(const TrackedLobes& lobes, const Eigen::VectorXd& step) {
  Eigen::VectorXd x = lobes.x;
  for (Index i = 0; i < x.size(); ++i) {
    const int p = parameter_of(lobes.model, i);
    x[i] = std::clamp(x[i] + std::clamp(step[i], -kMaxStep, kMaxStep), lower_bound(p), upper_bound(p));
  }
  return x;
}

/// 1 for unknowns that may move, otherwise 0. Unknowns at a bound that a step would cross are held, because the step of
/// the others would rely on a move that the bound prevents.
Eigen::VectorXd free_to_move(const TrackedLobes& lobes, const Eigen::VectorXd& gradient, Free free) {
  Eigen::VectorXd out = Eigen::VectorXd::Ones(lobes.x.size());
  for (Index i = 0; i < out.size(); ++i) {
    const int p = parameter_of(lobes.model, i);
    const bool color = p >= P::kLogRed && p <= P::kLogBlue;
    const bool held =
        (lobes.x[i] <= lower_bound(p) && gradient[i] > 0) || (lobes.x[i] >= upper_bound(p) && gradient[i] < 0);
    if (held || (free == Free::colors && !color)) out[i] = 0;
  }
  return out;
}

/// Damping of a step, adapted by the ratio of actual to predicted gain of earlier steps [Nie99].
class Damping {
 public:
  double value() const { return value_; }
  void taken(double share) {
    const double factor = 1 - std::pow(2 * share - 1, 3);
    value_ = std::max(value_ * std::clamp(factor, kFastestFall, kSlowestRise), kLeastDamping);
    rise_ = kFirstRise;
  }
  void refused() {
    value_ *= rise_;
    rise_ *= 2;
  }

 private:
  static constexpr double kFirstRise = 4;
  double value_ = kFirstDamping, rise_ = kFirstRise;
};

}  // namespace

double lower_bound(int parameter) {
  switch (parameter) {
    case P::kLogBandwidth:
      return -4;
    case P::kTiltX:
    case P::kTiltY:
      return -1.875;
    case P::kStretchA:
    case P::kStretchB:
      return -2.5;
    default:
      return -25;
  }
}

double upper_bound(int parameter) {
  switch (parameter) {
    case P::kLogBandwidth:
      return 16;
    case P::kTiltX:
    case P::kTiltY:
      return 1.875;
    case P::kStretchA:
    case P::kStretchB:
      return 2.5;
    default:
      return 16;
  }
}

void refine(TrackedProblem& problem, TrackedLobes& lobes, int most, double least, Free free) {
  Damping damping;
  std::vector<LocalNormal> local;
  for (int step = 0; step < most; ++step) {
    lobes.cost = problem.linearise(lobes.model, lobes.x, local);
    const TrackedNormal normal(lobes.model, problem, std::move(local), lobes.x);
    const Eigen::VectorXd moving = free_to_move(lobes, normal.gradient(), free);
    const double before = lobes.cost;
    for (int trial = 0; trial < kTrials && lobes.cost == before; ++trial) {
      const Eigen::VectorXd x = stepped(lobes, normal.step(damping.value(), moving));
      const double cost = problem.evaluate(lobes.model, x);
      if (cost < before) {
        damping.taken((before - cost) / std::max(normal.promised(x - lobes.x), 1e-12 * before));
        lobes.x = x, lobes.cost = cost;
      } else {
        damping.refused();
      }
    }
    if (before - lobes.cost < least * before) break;
  }
  // Errors and residuals of the result, not of the last trial.
  lobes.cost = problem.evaluate(lobes.model, lobes.x);
}

}  // namespace velour

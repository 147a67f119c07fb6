#include "fit/tracked_solver.h"

#include <algorithm>

namespace velour {
namespace {

using Index = Eigen::Index;
using P = ParametricBrdf;

constexpr double kFirstDamping = 1e-2, kLeastDamping = 1e-6;
constexpr int kTrials = 6;
constexpr double kMaxStep = 1;  // of a control value: a factor e, a radian

int parameter_of(const P& model, Index i) { return static_cast<int>(i / model.lobe_count()) % model.parameter_count(); }

Eigen::VectorXd stepped(const TrackedLobes& lobes, const Eigen::VectorXd& step) {
  Eigen::VectorXd x = lobes.x;
  for (Index i = 0; i < x.size(); ++i) {
    const int p = parameter_of(lobes.model, i);
    x[i] = std::clamp(x[i] + std::clamp(step[i], -kMaxStep, kMaxStep), lower_bound(p), upper_bound(p));
  }
  return x;
}

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
  double damping = kFirstDamping;
  std::vector<LocalNormal> local;
  for (int step = 0; step < most; ++step) {
    lobes.cost = problem.linearise(lobes.model, lobes.x, local);
    const TrackedNormal normal(lobes.model, problem.views(), std::move(local), lobes.x);
    const double before = lobes.cost;
    for (int trial = 0; trial < kTrials && lobes.cost == before; ++trial) {
      const Eigen::VectorXd x = stepped(lobes, normal.step(damping, free));
      const double cost = problem.evaluate(lobes.model, x);
      damping = cost < before ? std::max(damping / 4, kLeastDamping) : damping * 4;
      if (cost < before) lobes.x = x, lobes.cost = cost;
    }
    if (before - lobes.cost < least * before) break;
  }
  // Errors and residuals of the result, not of the last trial.
  lobes.cost = problem.evaluate(lobes.model, lobes.x);
}

}  // namespace velour

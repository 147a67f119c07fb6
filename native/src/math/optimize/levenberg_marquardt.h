// Damped Gauss-Newton descent in a few parameters, and the choice among several starts.
#pragma once

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>
#include <functional>
#include <span>
#include <vector>

#include "base/parallel.h"

namespace velour {

/// The Gauss-Newton model of a cost: curvature * step = -slope. Up to `kMost` unknowns, without allocation.
template <int kMost>
struct NormalEquations {
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMost, kMost> curvature;
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMost, 1> slope;

  explicit NormalEquations(Eigen::Index size) {
    curvature.setZero(size, size);
    slope.setZero(size);
  }

  /// Fixes the unknown `at`: for an unknown at its bound that would cross it.
  void freeze(Eigen::Index at) {
    curvature.row(at).setZero();
    curvature.col(at).setZero();
    curvature(at, at) = 1;
    slope[at] = 0;
  }

  /// Solution of the equations after the diagonal of the curvature is scaled by 1 + `damping`.
  Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMost, 1> step(double damping) const {
    auto damped = curvature;
    damped.diagonal() += damping * curvature.diagonal();
    damped.diagonal().array() += 1e-12;
    return -damped.ldlt().solve(slope);
  }
};

/// How a descent proceeds.
struct DescentOptions {
  int steps = 40;
  double settled = 1e-5;  // relative gain of a step below which the descent ends
  double damping = 1e-3;  // of the first step
  bool by_gain = false;   // damping follows the gain of a step over the promised one [Nie99], not its success alone
};

/// Descends from `p` and calls `check` once per step. A problem has cost(p); normal(p), the NormalEquations at p or a
/// class with the same `slope` and step(); and moved(p, step), the parameters after a step, within their bounds.
template <class Problem, class Parameters>
Parameters descend(const Problem& problem, Parameters p, const std::function<void()>& check,
                   const DescentOptions& options = {}) {
  double now = problem.cost(p), damping = options.damping, growth = options.by_gain ? 2 : 5;
  auto n = problem.normal(p);
  for (int step = 0; step < options.steps && damping < 1e8; ++step) {
    check();
    const auto by = n.step(damping);
    const Parameters to = problem.moved(p, by);
    const double then = problem.cost(to);
    if (!(then < now)) {
      damping *= growth;
      if (options.by_gain) growth *= 2;
      continue;
    }
    const bool settled = now - then < options.settled * now;
    const double surplus = 2 * (now - then) / -n.slope.dot(by) - 1;
    p = to;
    now = then;
    if (settled) break;
    damping = std::max((options.by_gain ? std::max(1.0 / 3, 1 - std::pow(surplus, 3)) : 0.2) * damping, 1e-9);
    if (options.by_gain) growth = 2;
    n = problem.normal(p);
  }
  return p;
}

template <class Parameters>
struct Candidate {
  Parameters parameters;
  double cost;
};

template <class Parameters>
bool better(const Candidate<Parameters>& a, const Candidate<Parameters>& b) {
  return a.cost < b.cost;
}

/// The completed starts with their costs, in the order of `starts`.
template <class Problem, class Parameters>
std::vector<Candidate<Parameters>> judged(const Problem& problem, std::span<const Parameters> starts, int threads,
                                          Progress& progress) {
  std::vector<Candidate<Parameters>> candidates(starts.size());
  parallel_for_each(starts.size(), threads, progress, [&](size_t i) {
    candidates[i].parameters = problem.completed(starts[i]);
    candidates[i].cost = problem.cost(candidates[i].parameters);
  });
  return candidates;
}

/// Best result of descents from all `candidates`, at least one; the first of equal ones.
template <class Problem, class Parameters>
Parameters best_descent(const Problem& problem, std::vector<Candidate<Parameters>> candidates, int threads,
                        Progress& progress) {
  parallel_for_each(candidates.size(), threads, progress, [&](size_t i) {
    Candidate<Parameters>& c = candidates[i];
    c.parameters = descend(problem, c.parameters, [&] { progress.check(); });
    c.cost = problem.cost(c.parameters);
  });
  return std::min_element(candidates.begin(), candidates.end(), better<Parameters>)->parameters;
}

}  // namespace velour

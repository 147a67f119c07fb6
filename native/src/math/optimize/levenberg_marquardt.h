// Damped Gauss-Newton descent in a few parameters, and the choice among several starts.
#pragma once

#include <algorithm>
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
};

/// Descends from `p` and calls `check` once per step. A problem has cost(p); normal(p), the NormalEquations at p; and
/// moved(p, step), the parameters after a step, within their bounds.
template <class Problem, class Parameters>
Parameters descend(const Problem& problem, Parameters p, const std::function<void()>& check) {
  constexpr int kSteps = 40;
  constexpr double kSettled = 1e-5;  // relative gain of a step below which the descent ends
  double now = problem.cost(p), damping = 1e-3;
  auto n = problem.normal(p);
  for (int step = 0; step < kSteps && damping < 1e8; ++step) {
    check();
    auto damped = n.curvature;
    damped.diagonal() += damping * n.curvature.diagonal();
    damped.diagonal().array() += 1e-12;
    const Parameters to = problem.moved(p, (-damped.ldlt().solve(n.slope)).eval());
    const double then = problem.cost(to);
    if (!(then < now)) {
      damping *= 5;
      continue;
    }
    const bool settled = now - then < kSettled * now;
    p = to;
    now = then;
    if (settled) break;
    damping = std::max(0.2 * damping, 1e-9);
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

#include "math/optimize/nnls.h"

#include <algorithm>
#include <Eigen/Cholesky>
#include <vector>

namespace velour {
namespace {

using Index = Eigen::Index;

/// Unconstrained solution on the entries of `passive`; 0 elsewhere.
Eigen::VectorXd solve_on(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment, double ridge,
                         const std::vector<Index>& passive) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(moment.size());
  if (passive.empty()) return x;
  Eigen::MatrixXd part = gram(passive, passive);
  part.diagonal() *= 1 + ridge;
  const Eigen::VectorXd solution = part.ldlt().solve(moment(passive).eval());
  for (size_t i = 0; i < passive.size(); ++i) {
    const double v = solution[static_cast<Index>(i)];
    x[passive[i]] = std::isfinite(v) ? v : 0.0;
  }
  return x;
}

std::vector<Index> positive_entries(const Eigen::VectorXd& x) {
  std::vector<Index> out;
  for (Index i = 0; i < x.size(); ++i) {
    if (x[i] > 0) out.push_back(i);
  }
  return out;
}

/// Moves from the feasible `x` towards the solution on the entries of `passive`, dropping the entry that reaches 0
/// first, until the solution is positive.
void descend(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment, double ridge, std::vector<Index> passive,
             Eigen::VectorXd& x) {
  while (!passive.empty()) {
    const Eigen::VectorXd goal = solve_on(gram, moment, ridge, passive);
    double step = 1;
    auto blocking = passive.end();
    for (auto i = passive.begin(); i != passive.end(); ++i) {
      if (goal[*i] > 0) continue;
      const double reach = x[*i] > 0 ? x[*i] / (x[*i] - goal[*i]) : 0.0;
      if (blocking == passive.end() || reach < step) step = reach, blocking = i;
    }
    if (blocking == passive.end()) {
      x = goal;
      return;
    }
    for (const Index i : passive) x[i] = std::max(0.0, x[i] + step * (goal[i] - x[i]));
    x[*blocking] = 0;  // exactly, despite rounding, so that every round drops an entry
    passive.erase(blocking);
  }
}

}  // namespace

void solve_nnls(const Eigen::MatrixXd& gram, const Eigen::VectorXd& moment, double ridge, Eigen::VectorXd& x) {
  const Index n = moment.size();
  if (x.size() != n) x = Eigen::VectorXd::Zero(n);
  x = x.cwiseMax(0.0);
  descend(gram, moment, ridge, positive_entries(x), x);
  for (Index round = 0; round < 3 * n; ++round) {
    const Eigen::VectorXd slope = moment - gram * x;
    Index best = -1;
    double most = 0;
    for (Index i = 0; i < n; ++i) {
      // Relative to the length of the column; 1e-10 is above the rounding of the sums and far below any useful gain.
      const double gain = slope[i] / std::sqrt(std::max(gram(i, i), 1e-300));
      const double noise = 1e-10 * std::abs(moment[i]) / std::sqrt(std::max(gram(i, i), 1e-300));
      if (x[i] == 0 && gain > noise && gain > most) most = gain, best = i;
    }
    if (best < 0) return;
    std::vector<Index> passive = positive_entries(x);
    passive.insert(std::lower_bound(passive.begin(), passive.end(), best), best);
    const Eigen::VectorXd before = x;
    descend(gram, moment, ridge, passive, x);
    if (x == before) return;  // the entry was added and dropped: rounding, not progress
  }
}

}  // namespace velour

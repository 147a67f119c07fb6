#include "math/optimize/lbfgs.h"

#include <deque>
#include <vector>

namespace velour {
namespace {

struct Move {
  Eigen::VectorXd step, change;  // changes of the parameters and of the slope
  double along() const { return step.dot(change); }
};

/// Product of the slope and the inverse Hessian, as approximated from the moves.
Eigen::VectorXd turned(const std::deque<Move>& moves, Eigen::VectorXd slope) {
  if (moves.empty()) return slope * (0.1 / slope.norm());
  std::vector<double> share(moves.size());
  for (size_t i = moves.size(); i-- > 0;) {
    share[i] = moves[i].step.dot(slope) / moves[i].along();
    slope -= share[i] * moves[i].change;
  }
  slope *= moves.back().along() / moves.back().change.squaredNorm();
  for (size_t i = 0; i < moves.size(); ++i) {
    slope += moves[i].step * (share[i] - moves[i].change.dot(slope) / moves[i].along());
  }
  return slope;
}

}  // namespace

Eigen::VectorXd descend_lbfgs(const SmoothFunction& f, Eigen::VectorXd x, const LbfgsOptions& options,
                              const std::function<void(int)>& after_step) {
  constexpr int kShorter = 8;       // number of cuts of a step that ends the descent
  constexpr double kCut = 0.4;      // factor of a cut
  constexpr double kEnough = 1e-4;  // minimum share of the gain that the slope predicts
  constexpr int kPatience = 10;
  Eigen::VectorXd slope, to_slope;
  double value = f(x, slope), earlier = value;
  std::deque<Move> moves;
  for (int step = 0; step < options.steps && slope.squaredNorm() > 0; ++step) {
    const Eigen::VectorXd direction = -turned(moves, slope);
    const double promised = slope.dot(direction);
    Eigen::VectorXd to;
    double length = 1, to_value = value;
    int cuts = 0;
    for (; cuts < kShorter; ++cuts, length *= kCut) {
      to = x + length * direction;
      to_value = f(to, to_slope);
      if (to_value <= value + kEnough * length * promised) break;
    }
    if (cuts == kShorter) break;
    Move move{to - x, to_slope - slope};
    if (move.along() > 1e-12 * move.change.squaredNorm()) moves.push_back(std::move(move));
    if (static_cast<int>(moves.size()) > options.memory) moves.pop_front();
    x = std::move(to);
    slope = to_slope;
    value = to_value;
    after_step(step);
    if (step % kPatience == kPatience - 1) {
      if (earlier - value < options.settled * std::abs(value)) break;
      earlier = value;
    }
  }
  return x;
}

}  // namespace velour

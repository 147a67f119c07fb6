#include "brdf/fit/parametric/solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <Eigen/Cholesky>

namespace velour::fit_problem_test {
namespace {

using P = ParametricBrdf;

/// Two lobes of both spaces on a spline of few cells.
struct Lobes {
  P model;
  Eigen::VectorXd x;
};

Lobes two_lobes(bool isotropic, double change) {
  Lobes lobes;
  lobes.model.isotropic = isotropic;
  lobes.model.cells = isotropic ? 4 : 2;
  lobes.model.space = {LobeSpace::half, LobeSpace::light};
  const int nodes = lobes.model.spline().node_count();
  lobes.x.resize(static_cast<Eigen::Index>(lobes.model.index(nodes, 0, 0)));
  for (int node = 0; node < nodes; ++node) {
    for (int k = 0; k < lobes.model.parameter_count(); ++k) {
      for (int j = 0; j < 2; ++j) {
        const double wave = std::sin(3.1 * node + 1.7 * k + j) + change * std::cos(5 * node + k);
        const double middle = k == P::kLogBandwidth ? (j == 0 ? 3.0 : 1.0) : 0.0;
        lobes.x[static_cast<Eigen::Index>(lobes.model.index(node, k, j))] = middle + 0.2 * wave;
      }
    }
  }
  return lobes;
}

constexpr int kParts = 1024;  // cells that the lobes cover, so that none is in excess

std::vector<MeasuredSlice> slices_of(const Lobes& lobes) {
  P brdf = lobes.model;
  for (const double v : lobes.x) brdf.control.push_back(static_cast<float>(v));
  std::vector<MeasuredSlice> slices;
  for (const float degrees : {2.0f, 20.0f, 41.0f, 63.0f, 80.0f, 88.0f}) {
    for (const float azimuth : {0.0f, 1.0f, 2.5f, 4.5f}) {
      if (brdf.isotropic && azimuth > 0) continue;
      const Vec3 wv = direction(radians_from(degrees), azimuth);
      const auto at_view = lobes_at(brdf, Vec3d(wv));
      const LightReader read = [&](std::span<const Vec3> wl, std::span<LightValue> values) {
        for (size_t i = 0; i < wl.size(); ++i) {
          values[i] = {.f = Rgb(value_of(at_view, Vec3d(wl[i]), Vec3d(wv))), .valid = true};
        }
      };
      MeasuredSlice slice{.wv = wv, .samples = {}};
      slice.lights = std::make_shared<const DirectionTree>(read, wv, kParts);
      for (const uint32_t leaf : slice.lights->leaves()) {
        const DirectionTree::Cell& cell = slice.lights->cell(leaf);
        slice.samples.push_back({cell.wl, static_cast<float>(cell.solid_angle()), cell.value.f * cell.wl.z});
      }
      slices.push_back(std::move(slice));
    }
  }
  return slices;
}

class ParametricProblem : public testing::TestWithParam<bool> {
 protected:
  Lobes truth_ = two_lobes(GetParam(), 0.0), start_ = two_lobes(GetParam(), 0.3);
  Progress progress_;
  FitProblem problem_{slices_of(truth_), truth_.model.spline(), [](const MeasuredSlice&) { return 0.02; }, true, 1,
                      progress_};
};

TEST_P(ParametricProblem, TheTruthHasNoErrorButThePenalty) {
  const double cost = problem_.evaluate(truth_.model, truth_.x);
  EXPECT_NEAR(cost, truth_.x.dot(smoothness_gradient(truth_.model, kSmoothness, truth_.x)), 1e-4);
  for (const FitView& v : problem_.views()) EXPECT_LT(v.error, 1e-4);
}

TEST_P(ParametricProblem, TheStepSolvesTheNormalEquationsOfTheCost) {
  std::vector<LocalNormal> local;
  const double here = problem_.linearize(start_.model, start_.x, local);
  const FitNormalEquations normal(start_.model, problem_, local, start_.x);
  const Eigen::VectorXd step = normal.step(1e-3, Eigen::VectorXd::Ones(start_.x.size()));
  // Gauss-Newton predicts the cost along its step: half the gradient's drop twice, plus the curvature.
  const double slope = (problem_.evaluate(start_.model, start_.x + 1e-4 * step) -
                        problem_.evaluate(start_.model, start_.x - 1e-4 * step)) /
                       2e-4;
  EXPECT_LT(slope, 0);
  EXPECT_LT(problem_.evaluate(start_.model, start_.x + 0.05 * step), here);
  // A full Newton step of a nearly quadratic cost lowers it by half the slope; far from it something is wrong.
  EXPECT_NEAR(problem_.evaluate(start_.model, start_.x + 0.05 * step), here + 0.05 * slope * (1 - 0.025), 0.05 * here);
}

TEST_P(ParametricProblem, WhatPicturesShowCountsBesideTheErrorAndLeavesItAsItIs) {
  std::vector<double> plain;
  const double before = problem_.evaluate(start_.model, start_.x);
  for (const FitView& v : problem_.views()) plain.push_back(v.error);
  for (int time = 0; time < 2; ++time) {  // called again, it starts from the weights of the samples
    problem_.weigh_for_pictures();
    double pictures = 0;
    const double cost = problem_.evaluate(start_.model, start_.x);
    for (size_t i = 0; i < plain.size(); ++i) {
      const FitView& v = problem_.views()[i];
      EXPECT_NEAR(v.error, plain[i], 1e-5 * plain[i]);
      pictures += std::pow(v.picture_error / kPictureGoal, 2);
    }
    EXPECT_GT(pictures, 0);
    EXPECT_NEAR(cost, before + pictures, 1e-5 * cost);
  }
}

TEST_P(ParametricProblem, TheGradientIsThatOfTheCost) {
  // Sharp enough to fall between the samples: the bound of the bandwidth speaks as well.
  Eigen::VectorXd x = start_.x;
  for (int node = 0; node < start_.model.spline().node_count(); ++node) {
    x[static_cast<Eigen::Index>(start_.model.index(node, P::kLogBandwidth, 1))] = 12;
  }
  problem_.weigh_for_pictures();
  std::vector<LocalNormal> local;
  problem_.linearize(start_.model, x, local);
  double excess = 0;
  for (const FitView& v : problem_.views()) excess += v.excess;
  EXPECT_GT(excess, 0);
  Eigen::VectorXd along = Eigen::VectorXd::Zero(x.size());
  for (int node = 0; node < start_.model.spline().node_count(); ++node) {
    for (int k : {static_cast<int>(P::kLogBandwidth), static_cast<int>(P::kLogGreen)}) {
      for (int j = 0; j < 2; ++j)
        along[static_cast<Eigen::Index>(start_.model.index(node, k, j))] = std::cos(node + k + j);
    }
  }
  constexpr double kStep = 1e-3;
  const double slope =
      (problem_.evaluate(start_.model, x + kStep * along) - problem_.evaluate(start_.model, x - kStep * along)) /
      (2 * kStep);
  const Eigen::VectorXd gradient = FitNormalEquations(start_.model, problem_, local, x).gradient();
  EXPECT_NEAR(2 * gradient.dot(along), slope, 2e-3 * std::abs(slope));
}

TEST_P(ParametricProblem, HeldParametersDoNotMove) {
  std::vector<LocalNormal> local;
  problem_.linearize(start_.model, start_.x, local);
  Eigen::VectorXd free = Eigen::VectorXd::Zero(start_.x.size());
  for (int node = 0; node < start_.model.spline().node_count(); ++node) {
    for (int k = P::kLogRed; k <= P::kLogBlue; ++k) {
      for (int j = 0; j < 2; ++j) free[static_cast<Eigen::Index>(start_.model.index(node, k, j))] = 1;
    }
  }
  const Eigen::VectorXd step = FitNormalEquations(start_.model, problem_, local, start_.x).step(1e-3, free);
  double moved = 0;
  for (int node = 0; node < start_.model.spline().node_count(); ++node) {
    for (int k = 0; k < start_.model.parameter_count(); ++k) {
      const double s = step[static_cast<Eigen::Index>(start_.model.index(node, k, 1))];
      if (k >= P::kLogRed && k <= P::kLogBlue)
        moved += std::abs(s);
      else
        EXPECT_EQ(s, 0);
    }
  }
  EXPECT_GT(moved, 0);
}

TEST_P(ParametricProblem, TheStepKeepsItsPromise) {
  std::vector<LocalNormal> local;
  const double here = problem_.linearize(start_.model, start_.x, local);
  const FitNormalEquations normal(start_.model, problem_, local, start_.x);
  const Eigen::VectorXd step = 1e-3 * normal.step(1e-3, Eigen::VectorXd::Ones(start_.x.size()));
  const double gained = here - problem_.evaluate(start_.model, start_.x + step);
  EXPECT_GT(gained, 0);
  EXPECT_NEAR(gained, normal.promised(step), 0.05 * gained);
}

TEST_P(ParametricProblem, OnlyColorsMoveWhenAsked) {
  FitLobes lobes{start_.model, start_.x, 0};
  refine(problem_, lobes, 3, 0, Free::colors);
  for (Eigen::Index i = 0; i < lobes.x.size(); ++i) {
    const int k = static_cast<int>(i / 2) % start_.model.parameter_count();
    const bool color = k >= P::kLogRed && k <= P::kLogBlue;
    EXPECT_TRUE(color || lobes.x[i] == start_.x[i]);
  }
  EXPECT_NE(lobes.x, start_.x);
}

TEST_P(ParametricProblem, ValuesAtABoundStayWithinIt) {
  FitLobes lobes{start_.model, start_.x, 0};
  for (int node = 0; node < lobes.model.spline().node_count(); ++node) {
    lobes.x[static_cast<Eigen::Index>(lobes.model.index(node, P::kTiltX, 0))] = upper_bound(P::kTiltX);
  }
  const double before = problem_.evaluate(lobes.model, lobes.x);
  refine(problem_, lobes, 10, 0);
  EXPECT_LT(lobes.cost, before);
  for (Eigen::Index i = 0; i < lobes.x.size(); ++i) {
    const int k = static_cast<int>(i / 2) % lobes.model.parameter_count();
    EXPECT_LE(lobes.x[i], upper_bound(k));
    EXPECT_GE(lobes.x[i], lower_bound(k));
  }
}

TEST_P(ParametricProblem, TheRemainderIsWhatTheLobesLeave) {
  problem_.evaluate(start_.model, start_.x);
  const std::vector<FitView> left = problem_.views();
  FitProblem remainder = problem_.remainder();
  P nothing = start_.model;
  nothing.space.clear();
  remainder.evaluate(nothing, Eigen::VectorXd());
  for (size_t i = 0; i < left.size(); ++i) {
    EXPECT_NEAR(remainder.views()[i].error, left[i].error, 1e-6 * left[i].error);
    EXPECT_EQ(remainder.views()[i].residual[1], left[i].residual[1]);
  }
}

TEST_P(ParametricProblem, RefinementFindsTheTruthAgain) {
  FitLobes lobes{start_.model, start_.x, 0};
  const double before = problem_.evaluate(start_.model, start_.x);
  refine(problem_, lobes, 60, 1e-6);
  EXPECT_LT(lobes.cost, 0.01 * before);
  for (const FitView& v : problem_.views()) EXPECT_LT(v.error, 2e-3);
}

TEST_P(ParametricProblem, RefinementIsNeverWorseThanItsStart) {
  FitLobes lobes{truth_.model, truth_.x, 0};
  const double before = problem_.evaluate(truth_.model, truth_.x);
  refine(problem_, lobes, 5, 0);
  EXPECT_LE(lobes.cost, before);
}

INSTANTIATE_TEST_SUITE_P(Symmetries, ParametricProblem, testing::Bool());

TEST(SplineThrough, PassesNearSmoothValues) {
  const Lobes lobes = two_lobes(true, 0);
  Progress progress;
  const FitProblem problem(
      slices_of(lobes), ViewSpline(true, 4), [](const MeasuredSlice&) { return 0.02; }, true, 1, progress);
  std::vector<double> wanted;
  for (const FitView& v : problem.views()) wanted.push_back(std::cos(std::acos(v.wv.z)));
  const Eigen::VectorXd control = spline_through(problem.views(), ViewSpline(true, 4), wanted, false);
  for (size_t i = 0; i < wanted.size(); ++i) {
    const ViewTaps& taps = problem.views()[i].taps;
    double value = 0;
    for (int t = 0; t < taps.count; ++t) value += taps.weight[t] * control[taps.node[t]];
    EXPECT_NEAR(value, wanted[i], 0.02);
  }
}

}  // namespace
}  // namespace velour::fit_problem_test

#include "btf/fit/srbf/lobe_order.h"

#include <gtest/gtest.h>

#include "btf/model/srbf_btf.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour::lobe_refinement_test {
namespace {

constexpr uint32_t kTileLobes = 3;

std::vector<MultivariateLobe> true_lobes() {
  return {{Vec3(1, 0.5f, 2), Vec3(0.2f, 0.1f, 0.3f), Vec3(0.1f, 0, 0.2f), 0.4f},
          {Vec3(-2, 1, 3), Vec3(0.4f, -0.5f, 1), Vec3(0, 0.3f, 0.4f), -0.3f},
          {Vec3(0.3f, 0, 0.5f), Vec3(-1, 0.6f, 2), Vec3(0.2f, 0, 0.1f), 0.2f},
          {Vec3(0.2f, 0.3f, 0.4f), Vec3(0.1f, 0, 0.3f), Vec3(0.5f, 0, 15), 1}};
}

/// Points with normals and coefficients of their own: sums of the true lobes.
std::vector<SurfacePoint> points_of(const std::vector<MultivariateLobe>& lobes) {
  std::vector<SurfacePoint> points(24);
  const LobeValues values(lobes, kTileLobes);
  for (size_t i = 0; i < points.size(); ++i) {
    RandomStream random(9, i, 0);
    SurfacePoint& point = points[i];
    point.to_normal = to_normal((random.next2() - 0.5f) * 2.0f);
    for (int pair = 0; pair < 80; ++pair) {
      const Vec3 wl = sample_cosine_hemisphere(random.next2());
      point.pair.emplace_back(DirectionPair{wl, sample_cosine_hemisphere(random.next2())});
    }
    const RowMatrix column = values.at(point, point.pair.size());
    Eigen::VectorXf coefficient(column.cols());
    for (float& c : coefficient) c = random.next() + 0.2f;
    const Eigen::VectorXf value = column * coefficient;
    for (auto& axis : point.value) axis.assign(value.begin(), value.end());
  }
  return points;
}

std::vector<MultivariateLobe> perturbed(std::vector<MultivariateLobe> lobes, float by) {
  RandomStream random(10, 0, 0);
  for (MultivariateLobe& lobe : lobes) {
    const MultivariateLobe from = lobe;
    for (int i = 0; i < MultivariateLobe::kNumbers; ++i) {
      lobe[i] += by * (1 + from.length(i / 3)) * (random.next() - 0.5f);
    }
  }
  return lobes;
}

double error_of(const std::vector<SurfacePoint>& points, const std::vector<MultivariateLobe>& lobes) {
  const Progress progress;
  Eigen::MatrixXd slope;
  return ProjectedError(points, kTileLobes, 1, progress)(lobes, slope);
}

std::vector<MultivariateLobe> refined(const std::vector<SurfacePoint>& points,
                                      const std::vector<MultivariateLobe>& lobes, int steps, int threads = 2) {
  Progress progress;
  return refine_lobes(points, lobes, {kTileLobes, steps, threads}, progress);
}

TEST(ProjectedError, HasTheSlopeOfItsDifferences) {
  const auto points = points_of(true_lobes());
  const auto lobes = perturbed(true_lobes(), 0.5f);
  const Progress progress;
  const ProjectedError error(points, kTileLobes, 2, progress);
  Eigen::MatrixXd slope, unused;
  error(lobes, slope);
  for (size_t j = 0; j < lobes.size(); ++j) {
    for (int i = 0; i < MultivariateLobe::kNumbers; ++i) {
      const float step = 0.02f;
      double value[2];
      for (const int side : {0, 1}) {
        auto moved = lobes;
        moved[j][i] += side ? step : -step;
        value[side] = error(moved, unused);
      }
      const double expected = (value[1] - value[0]) / (2.0 * static_cast<double>(step));
      EXPECT_NEAR(slope(i, static_cast<Eigen::Index>(j)), expected, 0.02 * slope.cwiseAbs().maxCoeff())
          << j << ' ' << i;
    }
  }
}

TEST(ProjectedError, OfTheTrueLobesIsTheRidgeAlone) {
  const auto points = points_of(true_lobes());
  EXPECT_LT(error_of(points, true_lobes()), 1e-3 * error_of(points, perturbed(true_lobes(), 1)));
}

TEST(ProjectedError, TakesPointsThatNoPairShows) {
  auto points = points_of(true_lobes());
  const double error = error_of(points, true_lobes());
  points.emplace_back();
  EXPECT_EQ(error_of(points, true_lobes()), error);
}

TEST(LobeRefinement, RecoversLobesThatWereMoved) {
  const auto points = points_of(true_lobes());
  const auto start = perturbed(true_lobes(), 0.4f), found = refined(points, start, 200);
  const double before = error_of(points, start), after = error_of(points, found),
               ideal = error_of(points, true_lobes());
  EXPECT_GT(before - ideal, 30 * (after - ideal));
}

TEST(LobeRefinement, IsNeverWorseThanItsStart) {
  const auto points = points_of(true_lobes());
  for (const float by : {0.0f, 0.2f, 3.0f}) {
    const auto start = perturbed(true_lobes(), by);
    double before = error_of(points, start);
    for (const int steps : {0, 1, 5, 20}) {
      const double after = error_of(points, refined(points, start, steps));
      EXPECT_LE(after, before * (1 + 1e-6)) << by << ' ' << steps;
      before = after;
    }
  }
}

TEST(LobeRefinement, IsTheSameForAnyNumberOfThreads) {
  const auto points = points_of(true_lobes());
  const auto start = perturbed(true_lobes(), 0.5f);
  const auto one = refined(points, start, 10, 1), two = refined(points, start, 10, 2);
  for (size_t j = 0; j < one.size(); ++j) {
    EXPECT_EQ(one[j].light, two[j].light);
    EXPECT_EQ(one[j].view, two[j].view);
    EXPECT_EQ(one[j].half, two[j].half);
  }
}

}  // namespace
}  // namespace velour::lobe_refinement_test

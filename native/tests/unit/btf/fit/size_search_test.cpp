#include "btf/fit/size_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include "support/warnings.h"

namespace velour::size_search_test {
namespace {

constexpr size_t kPoints = 200;

/// Errors fall with the root of the size.
OrderCurve falling_curve() {
  OrderCurve curve;
  for (size_t i = 0; i < kPoints; ++i) {
    curve.points.push_back({static_cast<int>(i + 1), 1000 * (i + 1), 0, 1 / std::sqrt(static_cast<double>(i + 1))});
  }
  return curve;
}

/// Runs the search against true errors.
template <class Truth>
SizeSearch searched(double tolerance, size_t largest, const Truth& truth) {
  SizeSearch search(falling_curve(), largest, tolerance);
  while (const auto point = search.next()) search.add(*point, truth(*point));
  return search;
}

double expected(size_t point) { return falling_curve().points[point].relative_l2; }

TEST(SizeSearch, FitsOnceWhereTheCurveIsRight) {
  const SizeSearch search = searched(0.1, kPoints - 1, expected);
  EXPECT_EQ(search.trials().size(), 1u);
  EXPECT_EQ(search.best(), 99u);
  EXPECT_TRUE(search.met());
}

TEST(SizeSearch, WithoutAToleranceFitsTheLargest) {
  const SizeSearch search = searched(0, 70, expected);
  EXPECT_EQ(search.trials().size(), 1u);
  EXPECT_EQ(search.best(), 70u);
  EXPECT_TRUE(search.met());
}

/// Whether fits are better than expected, worse, or increasingly worse, the size found is close to the smallest.
TEST(SizeSearch, LearnsTheHeightOfTheCurve) {
  const auto better = [](size_t p) { return 0.6 * expected(p); };
  const auto worse = [](size_t p) { return 1.25 * expected(p); };
  const auto flatter = [](size_t p) { return std::pow(expected(p), 0.9); };
  for (const std::function<double(size_t)>& truth : {std::function<double(size_t)>(better), {worse}, {flatter}}) {
    const SizeSearch search = searched(0.1, kPoints - 1, truth);
    ASSERT_TRUE(search.met());
    EXPECT_LE(search.trials().size(), 5u);
    size_t smallest = 0;
    while (truth(smallest) > 0.1) ++smallest;
    EXPECT_GE(search.best(), smallest);
    EXPECT_LE(search.best(), smallest + 2 + smallest / 10);
  }
}

/// A fit that is worse than a smaller one is passed over.
TEST(SizeSearch, SurvivesAFitThatWentWrong) {
  const SizeSearch search = searched(0.1, kPoints - 1, [](size_t p) { return p == 99 ? 0.3 : 0.8 * expected(p); });
  ASSERT_TRUE(search.met());
  EXPECT_LE(search.trials().size(), 6u);
}

TEST(SizeSearch, SaysByHowMuchTheToleranceIsMissed) {
  const SizeSearch bounded = searched(0.1, 49, expected);
  EXPECT_FALSE(bounded.met());
  EXPECT_EQ(bounded.best(), 49u);
  const Warning told = bounded.shortfall();
  EXPECT_EQ(told.code, WarningCode::tolerance_needs_bytes);
  EXPECT_NEAR(test::value_of<double>(told, "error"), 0.1414, 5e-5);
  EXPECT_EQ(test::value_of<uint64_t>(told, "enough"), 100000u);
  const Warning far = searched(0.01, 49, expected).shortfall();
  EXPECT_EQ(far.code, WarningCode::tolerance_needs_more_bytes);
  EXPECT_EQ(test::value_of<uint64_t>(far, "largest"), 200000u);
  const Warning never = searched(0.01, kPoints - 1, expected).shortfall();
  EXPECT_EQ(never.code, WarningCode::tolerance_out_of_reach);
  EXPECT_NEAR(test::value_of<double>(never, "reachable"), 0.0728, 5e-5);
}

TEST(SizeSearch, KeepsTheCurveAtTheHeightsThatWereMeasured) {
  const SizeSearch search = searched(0.1, kPoints - 1, [](size_t p) { return 0.6 * expected(p); });
  const OrderCurve curve = search.measured_curve(10);
  ASSERT_TRUE(curve.chosen.has_value());
  EXPECT_EQ(curve.points[*curve.chosen].parameter_bytes, 1000 * (search.best() + 1));
  EXPECT_LE(curve.points.size(), 10u + search.trials().size());
  EXPECT_EQ(curve.points.front().lobes, 1);
  EXPECT_EQ(curve.points.back().lobes, static_cast<int>(kPoints));
  for (const OrderPoint& point : curve.points) {
    EXPECT_NEAR(point.relative_l2, 0.6 / std::sqrt(point.lobes), 1e-9);
    EXPECT_NEAR(point.worst, point.relative_l2 / 0.1, 1e-9);
  }
}

}  // namespace
}  // namespace velour::size_search_test

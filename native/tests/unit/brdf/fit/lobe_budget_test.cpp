#include "brdf/fit/per_view/per_view_fit.h"

#include <gtest/gtest.h>

namespace velour::lobe_budget_test {
namespace {

ViewPath path_of(std::vector<double> errors, double importance) {
  ViewPath view{{}, importance};
  for (const double e : errors) view.path.push_back({{}, Vec3d(0), e});
  return view;
}

TEST(LobeBudget, TakesLobesWhereTheyMatterLeast) {
  const std::vector<ViewPath> views{path_of({1, 0.5, 0.4, 0.39}, 1), path_of({1, 0.8, 0.4, 0.1}, 1)};
  EXPECT_EQ(share_lobes(views, 5), (std::vector<size_t>{2, 3}));
  EXPECT_EQ(share_lobes(views, 4), (std::vector<size_t>{1, 3}));
  EXPECT_EQ(share_lobes(views, 100), (std::vector<size_t>{3, 3}));
}

TEST(LobeBudget, MayTakeAllLobes) {
  const std::vector<ViewPath> views{path_of({1, 0.5, 0.4}, 1), path_of({1, 0.8, 0.4}, 1)};
  EXPECT_EQ(share_lobes(views, 0), (std::vector<size_t>{0, 0}));
}

TEST(LobeBudget, SeesBehindAFlatStretch) {
  // Two lobes together save much, the last alone nothing: the pair must not be torn apart at the wrong place.
  const std::vector<ViewPath> views{path_of({1, 0.9, 0.9, 0.1}, 1), path_of({1, 0.5, 0.3, 0.2}, 1)};
  EXPECT_EQ(share_lobes(views, 4), (std::vector<size_t>{3, 1}));
}

TEST(LobeBudget, ThinsEvenly) {
  EXPECT_EQ(thinned(9, 3), (std::vector<size_t>{0, 4, 8}));
  EXPECT_EQ(thinned(9, 1), (std::vector<size_t>{0}));
  EXPECT_EQ(thinned(3, 9), (std::vector<size_t>{0, 1, 2}));
}

}  // namespace
}  // namespace velour::lobe_budget_test

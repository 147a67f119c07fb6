#include "math/sphere/view_spline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace velour::view_spline_test {
namespace {

Vec3d view(double degrees, double azimuth = 0) {
  const double t = radians_from(degrees);
  return {std::sin(t) * std::cos(azimuth), std::sin(t) * std::sin(azimuth), std::cos(t)};
}

double value(const ViewTaps& taps, const std::vector<double>& control, bool odd = false) {
  double sum = 0;
  for (int i = 0; i < taps.count; ++i) {
    sum += (odd ? taps.odd_weight[i] : taps.weight[i]) * control[static_cast<size_t>(taps.node[i])];
  }
  return sum;
}

std::vector<double> waves(const ViewSpline& spline) {
  std::vector<double> control;
  for (int i = 0; i < spline.node_count(); ++i) control.push_back(std::sin(1.7 * i * i));
  return control;
}

TEST(ViewSpline, WeightsSumToOneAndNodesAreThere) {
  for (const bool isotropic : {true, false}) {
    const ViewSpline spline(isotropic, 7);
    for (double degrees = 0; degrees <= 90; degrees += 0.7) {
      const ViewTaps taps = spline.at(view(degrees, 1.1));
      double sum = 0;
      for (int i = 0; i < taps.count; ++i) {
        sum += taps.weight[i];
        EXPECT_GE(taps.node[i], 0);
        EXPECT_LT(taps.node[i], spline.node_count());
      }
      EXPECT_NEAR(sum, 1, 1e-12);
    }
  }
}

TEST(ViewSpline, ANodeCountsMostAtItsView) {
  for (const bool isotropic : {true, false}) {
    for (const ViewRange range : {ViewRange{}, ViewRange{20, 50}}) {
      const ViewSpline spline(isotropic, 5, range);
      // The first one at the normal is its own mirror image, and counts most there.
      for (int node = isotropic && range.begin == 0 ? 1 : 0; node < spline.node_count(); ++node) {
        const PolarView<double> own = spline.view_of(node);
        EXPECT_LE(own.theta, range.last() + 1e-12);
        const auto weight_at = [&](const PolarView<double>& at) {
          const ViewTaps taps = spline.at(at);
          double weight = 0;
          for (int i = 0; i < taps.count; ++i) weight += taps.node[i] == node ? taps.weight[i] : 0.0;
          return weight;
        };
        // Beside it, along the radius: no more. Corners of the square count nowhere.
        for (const double beside : {-0.02, 0.02}) {
          const double theta = std::clamp(own.theta + beside, isotropic ? range.first() : 0.0, range.last());
          EXPECT_LE(weight_at({theta, own.cos_phi, own.sin_phi}), weight_at(own) + 1e-12) << node;
        }
      }
    }
  }
}

TEST(ViewSpline, IsSmoothAcrossCells) {
  for (const bool isotropic : {true, false}) {
    const ViewSpline spline(isotropic, 6);
    const auto control = waves(spline);
    const double step = 0.01;
    for (double degrees = step; degrees + step <= 90; degrees += step) {
      const double bend = value(spline.at(view(degrees + step, 0.3)), control) -
                          2 * value(spline.at(view(degrees, 0.3)), control) +
                          value(spline.at(view(degrees - step, 0.3)), control);
      EXPECT_LT(std::abs(bend), 1e-4) << degrees;  // a kink would leave 1e-3
    }
  }
}

TEST(ViewSpline, IsotropicValuesAreEvenAndOddAcrossTheNormal) {
  const ViewSpline spline(true, 9);
  const auto control = waves(spline);
  EXPECT_EQ(value(spline.at(view(0)), control, true), 0);
  EXPECT_NEAR(value(spline.at(view(0.01)), control), value(spline.at(view(0)), control), 1e-5);
  EXPECT_NEAR(value(spline.at(view(40, 0.2)), control), value(spline.at(view(40, 4)), control), 1e-12);
}

TEST(ViewSpline, HemisphereSplinesHaveNoSeam) {
  const ViewSpline spline(false, 5);
  const auto control = waves(spline);
  EXPECT_NEAR(value(spline.at(view(60, -kPiD + 1e-7)), control), value(spline.at(view(60, kPiD - 1e-7)), control),
              1e-6);
  EXPECT_NEAR(value(spline.at(view(1e-6, 0.1)), control), value(spline.at(view(1e-6, 4)), control), 1e-6);
}

TEST(ViewSpline, CoversARangeOfViewsAndHoldsItsEndsBeyond) {
  for (const bool isotropic : {true, false}) {
    const ViewSpline part(isotropic, 3, {20, 50});
    const auto control = waves(part);
    const double low = isotropic ? 20 : 0;
    EXPECT_EQ(value(part.at(view(50)), control), value(part.at(view(80)), control));
    if (isotropic) {
      EXPECT_EQ(value(part.at(view(20)), control), value(part.at(view(3)), control));
    }
    EXPECT_GT(std::abs(value(part.at(view(low + 5)), control) - value(part.at(view(45)), control)), 1e-3);
    for (double degrees = 0; degrees <= 90; degrees += 0.7) {
      const ViewTaps taps = part.at(view(degrees, 0.4));
      double sum = 0;
      for (int i = 0; i < taps.count; ++i) {
        sum += taps.weight[i];
        EXPECT_TRUE(taps.node[i] >= 0 && taps.node[i] < part.node_count());
      }
      EXPECT_NEAR(sum, 1, 1e-12);
    }
  }
}

TEST(ViewSpline, RefinedSplinesFollowWhatTheirOwnKnotsAllow) {
  const ViewSpline whole(true, 5), part(true, 2, {20, 50});
  const std::pair<ViewSpline, bool> cases[] = {{whole, false}, {whole, true}, {part, false}};
  for (const auto& [coarse, odd] : cases) {
    const ViewSpline fine = coarse.refined(3);
    const auto control = waves(coarse);
    auto values = fine.sites();
    ASSERT_EQ(static_cast<int>(values.size()), fine.node_count());
    for (double& v : values) v = value(coarse.at(PolarView<double>{v, 1, 0}), control, odd);
    fine.interpolate(values, odd);
    for (double degrees = 0; degrees <= 90; degrees += 0.37) {
      EXPECT_NEAR(value(fine.at(view(degrees)), values, odd), value(coarse.at(view(degrees)), control, odd), 1e-12);
    }
  }
}

TEST(ViewSpline, OfHalvedIntervalsIsTheSame) {
  const ViewSpline whole(true, 5), part(true, 2, {20, 50}), grid(false, 4), part_of_grid(false, 3, {0, 40});
  const std::pair<ViewSpline, bool> cases[] = {
      {whole, false}, {whole, true}, {part, false}, {grid, false}, {part_of_grid, false}};
  for (const auto& [coarse, odd] : cases) {
    const ViewSpline fine = coarse.refined(2);
    const auto control = waves(coarse), finer = coarse.halved(control, odd);
    ASSERT_EQ(static_cast<int>(finer.size()), fine.node_count());
    for (double degrees = 0; degrees <= 90; degrees += 0.37) {
      const Vec3d wv = view(degrees, coarse.isotropic() ? 0 : 0.1 * degrees);
      EXPECT_NEAR(value(fine.at(wv), finer, odd), value(coarse.at(wv), control, odd), 1e-12);
    }
  }
}

TEST(ViewSpline, TheRangeOfAllViewsChangesNothing) {
  const ViewSpline all(true, 5), named(true, 5, {0, 90}), upper(true, 5, {10, 90});
  EXPECT_EQ(all.node_count(), named.node_count());
  EXPECT_EQ(upper.node_count(), all.node_count() + 1);  // no mirror image at its first view
  const auto control = waves(all);
  for (double degrees = 0; degrees <= 90; degrees += 3.3) {
    EXPECT_EQ(value(all.at(view(degrees)), control), value(named.at(view(degrees)), control));
  }
}

TEST(PoleFade, GoesFromNothingToAll) {
  EXPECT_EQ(pole_fade(view(0)), 0);
  EXPECT_GT(pole_fade(view(8)), 0.9999);
}

}  // namespace
}  // namespace velour::view_spline_test

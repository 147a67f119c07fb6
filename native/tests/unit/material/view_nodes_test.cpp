#include "brdf/eval/view_nodes.h"

#include <gtest/gtest.h>

#include "math/sphere/directions.h"
#include "math/sphere/view_spline.h"

namespace velour::view_nodes_test {
namespace {

TEST(ViewPlace, HasTheAnglesOfTheView) {
  for (const Vec3& wv : hemisphere_fibonacci(1000)) {
    const ViewPlace place(wv);
    const PolarView<double> exact = polar_view(Vec3d(wv));
    EXPECT_NEAR(place.theta, exact.theta, 3e-7);
    EXPECT_NEAR(place.radius, std::sqrt(2.0) * std::sin(0.5 * exact.theta), 3e-7);
    EXPECT_NEAR(place.cos_phi, exact.cos_phi, 1e-6);
    EXPECT_NEAR(place.sin_phi, exact.sin_phi, 1e-6);
  }
  // Beside the normal, where 1 - z says nothing.
  EXPECT_NEAR(ViewPlace({3e-5f, 4e-5f, 1}).theta, 5e-5f, 1e-10f);
  const ViewPlace pole({0, 0, 1});
  EXPECT_EQ(pole.theta, 0);
  EXPECT_EQ(pole.cos_phi, 1);
  EXPECT_EQ(pole.sin_phi, 0);
  EXPECT_NEAR(ViewPlace({1, 0, 0}).theta, kPi / 2, 3e-7f);
}

TEST(ViewNodes, AViewIsTheMeanOfItsNodes) {
  for (const bool isotropic : {true, false}) {
    const ViewNodes nodes(isotropic, 20);
    for (const Vec3& wv : hemisphere_fibonacci(500)) {
      const Vec3 view = isotropic ? Vec3(std::sqrt(1 - wv.z * wv.z), 0, wv.z) : wv;
      const NodeWeights at = nodes.at(ViewPlace(view));
      Vec3 mean(0);
      float sum = 0;
      for (int i = 0; i < at.count; ++i) {
        EXPECT_GE(at.weight[i], 0);
        mean += at.weight[i] * nodes.view(at.node[i]);
        sum += at.weight[i];
      }
      EXPECT_NEAR(sum, 1, 1e-6f);
      EXPECT_LT(glm::distance(mean, view), view.z > 0.1f ? 0.01f : 0.05f)  // nodes off the disk are moved to its edge
          << isotropic << ' ' << view.z;
      EXPECT_LT(glm::distance(nodes.view(at.nearest), view), 0.12f);
    }
  }
}

TEST(ViewNodes, EachNodeIsAtItsView) {
  for (const bool isotropic : {true, false}) {
    const ViewNodes nodes(isotropic, 12);
    for (int node = 0; node < nodes.count(); ++node) {
      const Vec3 view = nodes.view(node);
      EXPECT_NEAR(glm::length(view), 1, 1e-6f);
      if (view.z < 1e-3f) continue;  // several nodes share a view there
      EXPECT_EQ(nodes.at(ViewPlace(view)).nearest, node);
    }
  }
}

// What renderers evaluate in float is the spline of the fit.
TEST(ViewSpline, IsTheSameInFloat) {
  for (const bool isotropic : {true, false}) {
    const ViewSpline spline(isotropic, 10);
    for (const Vec3& wv : hemisphere_fibonacci(300)) {
      const ViewPlace place(wv);
      const ViewTaps exact = spline.at(Vec3d(wv));
      const ViewTapsOf<float> taps = spline.at(PolarView<float>{place.theta, place.cos_phi, place.sin_phi});
      double even = 0, odd = 0;  // of a spline that is linear in the node: taps may differ by a cell
      for (int i = 0; i < exact.count; ++i) {
        even += exact.weight[i] * exact.node[i];
        odd += exact.odd_weight[i] * exact.node[i];
      }
      for (int i = 0; i < taps.count; ++i) {
        even -= static_cast<double>(taps.weight[i]) * taps.node[i];
        odd -= static_cast<double>(taps.odd_weight[i]) * taps.node[i];
      }
      EXPECT_NEAR(even, 0, 3e-4);
      EXPECT_NEAR(odd, 0, 3e-4);
    }
  }
}

}  // namespace
}  // namespace velour::view_nodes_test

#include "math/srbf/lobe_tree.h"

#include <gtest/gtest.h>

#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"
#include "math/srbf/kernel.h"

namespace velour::lobe_tree_test {
namespace {

constexpr GaussianLobe kEverywhere{{0, 0, 1}, 0, 1};

GaussianLobes many(int count) {
  GaussianLobes lobes;
  RandomStream random(3, 0, 0);
  for (int k = 0; k < count; ++k) {
    const float bandwidth = std::exp2(12 * random.next());
    lobes.add({sample_uniform_sphere(random.next2()), bandwidth, random.next() * bandwidth});
  }
  return lobes;
}

double energy(const GaussianLobe& lobe) {
  return static_cast<double>(lobe.amplitude) * kernel_integral(Kernel::gaussian, static_cast<double>(lobe.bandwidth));
}

Vec3d moment(const GaussianLobe& lobe) {
  return energy(lobe) * (1 - gaussian_one_minus_mean(static_cast<double>(lobe.bandwidth))) * Vec3d(lobe.center);
}

double value(const std::vector<GaussianLobe>& lobes, const Vec3& w) {
  double sum = 0;
  for (const GaussianLobe& lobe : lobes) {
    sum += static_cast<double>(lobe.amplitude) * kernel_value(Kernel::gaussian, static_cast<double>(lobe.bandwidth),
                                                              one_minus_dot(Vec3d(w), Vec3d(lobe.center)));
  }
  return sum;
}

TEST(LobeTree, EveryCutHoldsEnergyAndFirstMomentOfAll) {
  const GaussianLobes lobes = many(100);
  const LobeTree tree(lobes);
  double total = 0;
  Vec3d first(0);
  for (const GaussianLobe& lobe : tree.cut(kEverywhere, 1000)) total += energy(lobe), first += moment(lobe);
  for (const int most : {1, 2, 7, 32, 99}) {
    const GaussianLobe highlight{{0.6f, 0, 0.8f}, 200, 3};
    for (const GaussianLobe& asked : {kEverywhere, highlight}) {
      const auto nodes = tree.cut(asked, most);
      EXPECT_EQ(nodes.size(), static_cast<size_t>(most));
      double sum = 0;
      Vec3d moments(0);
      for (const GaussianLobe& node : nodes) sum += energy(node), moments += moment(node);
      EXPECT_NEAR(sum, total, 1e-6 * total);
      EXPECT_LT(glm::length(moments - first), 1e-5 * total);
    }
  }
}

TEST(LobeTree, WithRoomForAllTheLeavesAreTheLobes) {
  const GaussianLobes lobes = many(40);
  const auto nodes = LobeTree(lobes).cut(kEverywhere, 64);
  ASSERT_EQ(nodes.size(), lobes.size());
  for (const GaussianLobe& node : nodes) {
    int found = 0;
    for (size_t k = 0; k < lobes.size(); ++k) {
      found += node.center.x == lobes.x[k] && node.bandwidth == lobes.bandwidth[k];
    }
    EXPECT_EQ(found, 1);
  }
}

TEST(LobeTree, IsFineWhereItIsAsked) {
  // Relative error of 24 nodes for 200 lobes, over the directions that the lobe asked about weighs.
  const GaussianLobes lobes = many(200);
  const LobeTree tree(lobes);
  const auto exact = tree.cut(kEverywhere, 1000), anywhere = tree.cut(kEverywhere, 24);
  for (const Vec3& center : sphere_fibonacci(12)) {
    const auto there = tree.cut({center, 50, 1}, 24);
    double error_there = 0, error_anywhere = 0;
    for (const Vec3& w : sphere_fibonacci(4000)) {
      const double weight = kernel_value(Kernel::gaussian, 50, one_minus_dot(Vec3d(w), Vec3d(center)));
      error_there += weight * std::abs(value(there, w) - value(exact, w));
      error_anywhere += weight * std::abs(value(anywhere, w) - value(exact, w));
    }
    EXPECT_LT(error_there, 0.5 * error_anywhere);
  }
}

TEST(LobeTree, NeighborsInACutAreNearEachOther) {
  const auto nodes = LobeTree(many(200)).cut(kEverywhere, 64);
  double step = 0, any = 0;
  for (size_t i = 1; i < nodes.size(); ++i) {
    step += one_minus_dot(Vec3d(nodes[i].center), Vec3d(nodes[i - 1].center));
    any += one_minus_dot(Vec3d(nodes[i].center), Vec3d(nodes[(i * 37) % nodes.size()].center));
  }
  EXPECT_LT(step, 0.5 * any);
}

TEST(LobeTree, TakesWhatIsDegenerate) {
  EXPECT_TRUE(LobeTree({}).empty());
  EXPECT_TRUE(LobeTree({}).cut(kEverywhere, 4).empty());
  GaussianLobes black;
  black.add({{0, 0, 1}, 10, 0});
  EXPECT_TRUE(LobeTree(black).empty());

  GaussianLobes opposed;  // whose mean direction vanishes
  opposed.add({{0, 0, 1}, 1e6f, 1});
  opposed.add({{0, 0, -1}, 1e6f, 1});
  const auto root = LobeTree(opposed).cut(kEverywhere, 1);
  ASSERT_EQ(root.size(), 1u);
  EXPECT_NEAR(glm::length(root[0].center), 1, 1e-6);
  EXPECT_FLOAT_EQ(root[0].bandwidth, static_cast<float>(kMinMeanBandwidth));

  GaussianLobes same;
  for (int i = 0; i < 5; ++i) same.add({{1, 0, 0}, 100, 2});
  const auto joined = LobeTree(same).cut(kEverywhere, 3);
  ASSERT_FALSE(joined.empty());
  double total = 0;
  for (const GaussianLobe& node : joined) {
    total += energy(node);
    EXPECT_NEAR(node.bandwidth, 100, 1e-2);
  }
  EXPECT_NEAR(total, 10 * kernel_integral(Kernel::gaussian, 100), 1e-5 * total);
}

}  // namespace
}  // namespace velour::lobe_tree_test

#include "brdf/fit/direction_tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "brdf/eval/per_view_material.h"
#include "brdf/fit/error/compare.h"
#include "brdf/fit/slice_sampling.h"
#include "math/sphere/directions.h"
#include "math/sphere/frame.h"
#include "math/srbf/kernel.h"
#include "support/hostile_measurements.h"
#include "support/materials.h"

namespace velour::direction_tree_test {
namespace {

using Value = std::function<double(const Vec3& wl)>;

/// Gray f with f cos = `value`.
LightReader reading(const Value& value) {
  return [value](std::span<const Vec3> wl, std::span<LightValue> values) {
    for (size_t i = 0; i < wl.size(); ++i) {
      values[i] = {.f = Rgb(static_cast<float>(value(wl[i])) / std::max(wl[i].z, 1e-6f)), .valid = true};
    }
  };
}

Value lobe_about(const Vec3& center, double bandwidth) {
  return [center, bandwidth](const Vec3& wl) {
    return kernel_value(Kernel::gaussian, bandwidth, one_minus_dot(Vec3d(wl), Vec3d(center)));
  };
}

double cosine(const Vec3& wl) { return wl.z; }

double integral_of_leaves(const DirectionTree& tree, const Value& value) {
  double sum = 0;
  for (const uint32_t i : tree.leaves()) sum += tree.cell(i).solid_angle() * value(tree.cell(i).wl);
  return sum;
}

double integral_of_samples(const DirectionTree& tree, uint64_t seed, const Value& value) {
  constexpr size_t kCount = 1200;
  std::vector<Vec3> wl;
  tree.sample(kCount, seed, wl);
  double sum = 0;
  for (const Vec3& w : wl) sum += value(w) / (kCount * tree.density(w));
  return sum;
}

TEST(DirectionTree, LeavesCoverTheHemisphereOnce) {
  for (const bool folded : {false, true}) {
    const Vec3 wv = direction(radians_from(50.0f), folded ? 0.0f : 2.0f);
    const DirectionTree tree(reading(lobe_about(reflected(wv), 3000)), wv, 256, folded);
    EXPECT_NEAR(integral_of_leaves(tree, [](const Vec3&) { return 1.0; }), (folded ? 1 : 2) * kPiD, 1e-6);
    EXPECT_NEAR(integral_of_leaves(tree, cosine), (folded ? 0.5 : 1) * kPiD, 0.02);
    for (const uint32_t i : tree.leaves()) {
      EXPECT_EQ(&tree.leaf_at(tree.cell(i).wl), &tree.cell(i));
      EXPECT_NEAR(glm::length(tree.cell(i).wl), 1, 1e-6);
      EXPECT_TRUE(!folded || tree.cell(i).wl.y >= 0);
    }
  }
}

TEST(DirectionTree, NoLeafHoldsMoreThanItsPart) {
  constexpr int kParts = 256;
  const Vec3 wv = direction(radians_from(70.0f), 1.0f);
  const Value value = [&](const Vec3& w) { return 0.1 * w.z + 40 * lobe_about(reflected(wv), 2e4)(w); };
  const DirectionTree tree(reading(value), wv, kParts);
  double energy = 0, light = 0;
  for (const uint32_t i : tree.leaves()) {
    const double y = tree.cell(i).luminance_cos();
    energy += tree.cell(i).solid_angle() * y * y;
    light += tree.cell(i).solid_angle() * y;
  }
  for (const uint32_t i : tree.leaves()) {
    const double y = tree.cell(i).luminance_cos(), solid_angle = tree.cell(i).solid_angle();
    EXPECT_LT(0.5 * solid_angle * (y * y / energy + y / light), 1.05 / kParts);
  }
}

TEST(DirectionTree, WhatIsSmoothTakesFewLeaves) {
  const Vec3 wv = direction(radians_from(40.0f), 0.0f);
  EXPECT_LT(DirectionTree(reading(cosine), wv, 128).leaves().size(), 450u);
}

constexpr int kMeanSets = 64;

/// Mean and standard error of integrals by independent sets.
struct Mean {
  double value = 0, standard_error = 0;
  double of_one_set() const { return standard_error * std::sqrt(kMeanSets); }
};
Mean mean_of_sets(const DirectionTree& tree, const Value& value) {
  double sum = 0, square = 0;
  for (uint64_t seed = 0; seed < kMeanSets; ++seed) {
    const double x = integral_of_samples(tree, seed, value);
    sum += x, square += x * x;
  }
  const double mean = sum / kMeanSets;
  return {mean, std::sqrt(std::max(square / kMeanSets - mean * mean, 0.0) / (kMeanSets - 1))};
}

TEST(DirectionTree, FindsHighlightsOfEveryWidthAboutTheMirrorDirectionAndTheView) {
  for (const float theta : {0.0f, 0.3f, 0.8f, 1.4f}) {
    const Vec3 wv = direction(theta, 0.7f);
    for (const double bandwidth : {1e2, 1e3, 1e4, 1e5, 1e6, 1e7}) {
      for (const Vec3& center : {wv, reflected(wv)}) {
        if (center == wv && bandwidth > 1e5) continue;
        SCOPED_TRACE(testing::Message() << theta << ' ' << bandwidth << (center == wv ? " about the view" : ""));
        const Value lobe = lobe_about(center, bandwidth);
        const Value value = [&](const Vec3& w) { return 0.01 * w.z + 1e-3 * bandwidth * lobe(w); };
        const DirectionTree tree(reading(value), wv, 256);
        const Mean found = mean_of_sets(tree, lobe);
        const double exact = kernel_integral(Kernel::gaussian, bandwidth);
        if (theta < 1.3f) {  // otherwise the horizon cuts the lobe
          EXPECT_LT(std::abs(found.value - exact), 4 * found.standard_error);
        }
        // Errors are to be known to 5 % by four sets.
        EXPECT_LT(found.of_one_set(), 0.1 * found.value);
        // At least 150 leaves hold the lobe, each with a value that is off by up to half: 4 %, and their middles miss
        // 2 % of its tail. Two standard errors.
        EXPECT_NEAR(integral_of_leaves(tree, lobe) / found.value, 1, 0.1);
      }
    }
  }
}

TEST(DirectionTree, SamplesHaveTheirDensity) {
  const Vec3 wv = direction(radians_from(30.0f), 0.4f);
  const DirectionTree tree(reading(lobe_about(reflected(wv), 500)), wv, 256);
  // Not the function that the tree was made for, so that the sums of weights have something to get wrong.
  const Mean cosines = mean_of_sets(tree, cosine);
  EXPECT_LT(std::abs(cosines.value - kPiD), 4 * cosines.standard_error + 1e-4);
  const Value wrong = [&](const Vec3& w) { return cosine(w) * tree.density(w) * 2 * kPiD; };  // as if all were even
  const Mean biased = mean_of_sets(tree, wrong);
  EXPECT_GT(std::abs(biased.value - kPiD), 10 * biased.standard_error);
}

// --- errors

std::shared_ptr<const Material> narrow_lobe(const Vec3& center, double bandwidth) {
  PerViewBrdf brdf;
  brdf.views = {{0, 0, 1}};
  brdf.first_lobe = {0, 1};
  brdf.center = {center};
  brdf.bandwidth = {static_cast<float>(bandwidth)};
  brdf.coefficient = {Rgb(1)};
  brdf.isotropic = brdf.align_views = false;
  return make_per_view_material(std::make_shared<const PerViewBrdf>(brdf), 1);
}

double integral(const WeightedLights& lights, const Value& f) {
  double sum = 0;
  for (size_t i = 0; i < lights.wl.size(); ++i) sum += lights.weight[i] * f(lights.wl[i]);
  return sum;
}

TEST(ErrorLights, FillTheHemisphereAndFindTheLobesOfTheMaterialAnywhere) {
  const Vec3 wv(0, 0, 1), aside = direction(1.0f, 2.0f);
  const DirectionTree tree(reading(cosine), wv, 256);
  const auto material = narrow_lobe(aside, 1e6);
  double area = 0, lobe = 0;
  constexpr uint64_t kSets = 8;
  for (uint64_t set = 0; set < kSets; ++set) {
    const WeightedLights lights = error_lights(tree, *material, wv, set);
    area += integral(lights, [](const Vec3&) { return 1.0; }) / kSets;
    lobe += integral(lights, lobe_about(aside, 1e6)) / kSets;
  }
  EXPECT_NEAR(area, 2 * kPiD, 0.02 * 2 * kPiD);
  EXPECT_NEAR(lobe / kernel_integral(Kernel::gaussian, 1e6), 1, 0.03);
}

TEST(ErrorEstimate, ItsStandardErrorIsTheSpreadOfItsErrors) {
  const test::AnalyticMeasurement measurement(test::near_mirror(1e4));
  const Vec3 wv = direction(radians_from(30.0f), 0);
  const DirectionTree tree(reader_of(measurement, wv), wv, 64);
  const auto material = narrow_lobe(reflected(wv), 9e3);
  constexpr size_t kGroups = 48, kSets = 4;
  double sum = 0, square = 0, claimed = 0;
  for (size_t group = 0; group < kGroups; ++group) {
    std::vector<ViewError> sets(kSets);
    for (size_t k = 0; k < kSets; ++k) {
      const WeightedLights lights = error_lights(tree, *material, wv, group * kSets + k);
      for (size_t i = 0; i < lights.wl.size(); ++i) {
        const DirectionPair pair{lights.wl[i], wv};
        const Rgb model(static_cast<float>(600 * lobe_about(reflected(wv), 9e3)(pair.wl)));
        sets[k].add(lights.weight[i], test::near_mirror(1e4)(pair), model, pair.wl.z);
      }
    }
    const ErrorEstimate estimate = error_estimate(sets);
    sum += estimate.error, square += estimate.error * estimate.error;
    claimed += estimate.standard_error * estimate.standard_error / kGroups;
  }
  const double mean = sum / kGroups, variance = (square / kGroups - mean * mean) * kGroups / (kGroups - 1);
  EXPECT_GT(variance, 0);
  // The ratio of variances of 47 and 144 degrees of freedom lies within these bounds in 999 of 1000 cases.
  EXPECT_GT(claimed / variance, 0.45);
  EXPECT_LT(claimed / variance, 2.4);
}

}  // namespace
}  // namespace velour::direction_tree_test

#include "brdf/fit/per_view/slice_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "unit/brdf/fit/shape_value.h"

namespace velour::slice_solver_test {
namespace {

using test::shape_value;
using Lobes = std::vector<SliceLobe>;

Vec3d unit(double x, double y, double z) { return glm::normalize(Vec3d(x, y, z)); }

Lobes three_lobes() {
  return {{{unit(0.5, 0, 0.8), 60}, {2, 1.5, 1}},
          {{unit(-0.3, 0.4, 0.7), 12}, {0.5, 0.7, 0.9}},
          {{unit(0.1, -0.2, 0.9), 1}, {0.2, 0.1, 0.3}}};
}

SliceSamples samples_of(Kernel kernel, const Lobes& lobes, int n, const Mat3& turn = Mat3(1)) {
  std::vector<SliceSample> samples;
  for (const Vec3& w : hemisphere_fibonacci(n)) {
    Vec3d value(0);
    for (const SliceLobe& l : lobes) value += l.peak * shape_value(kernel, l.shape, Vec3d(w));
    samples.push_back({turn * w, 2 * kPi / static_cast<float>(n), Rgb(value)});
  }
  return SliceSamples(samples);
}

std::vector<LobeShape> disturbed(const Lobes& lobes, double by) {
  std::vector<LobeShape> out;
  double sign = 1;
  for (const SliceLobe& l : lobes) {
    out.push_back({glm::normalize(l.shape.center + by * Vec3d(sign, -sign, 0.5 * sign)),
                   l.shape.sharpness * std::exp(3 * sign * by)});
    sign = -sign;
  }
  return out;
}

double squared_error_ratio(const SliceSolver& solver, const SliceSamples& samples) {
  double error = 0, energy = 0;
  for (int c = 0; c < 3; ++c) {
    for (size_t i = 0; i < samples.count(); ++i) error += std::pow(solver.residual(c)[i], 2);
    energy += samples.energy(c);
  }
  return error / energy;
}

class Recovery : public testing::TestWithParam<Kernel> {};

TEST_P(Recovery, FindsTheLobesThatMadeTheData) {
  const SliceSamples samples = samples_of(GetParam(), three_lobes(), 3000);
  const Progress progress;
  SliceSolver solver(GetParam(), samples, progress);
  solver.set_lobes(disturbed(three_lobes(), 0.05));
  solver.refine(300, 0, 0);
  EXPECT_LT(squared_error_ratio(solver, samples), 1e-6);
  const Lobes truth = three_lobes(), found = solver.lobes();
  for (size_t j = 0; j < truth.size(); ++j) {
    // The broad lobe's center hardly matters to the data.
    const double loose = j == 2 ? 30 : 1;
    EXPECT_NEAR(glm::distance(found[j].shape.center, truth[j].shape.center), 0, 2e-3 * loose);
    EXPECT_NEAR(found[j].shape.sharpness / truth[j].shape.sharpness, 1, 5e-3 * loose);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[j].peak[c] / truth[j].peak[c], 1, 5e-3 * loose);
  }
}

TEST_P(Recovery, ADifferentModelIsNotTakenForExact) {
  // The control of the test above: two lobes cannot be three.
  const SliceSamples samples = samples_of(GetParam(), three_lobes(), 3000);
  const Progress progress;
  SliceSolver solver(GetParam(), samples, progress);
  auto shapes = disturbed(three_lobes(), 0.05);
  shapes.erase(shapes.begin() + 1);
  solver.set_lobes(shapes);
  solver.refine(300, 0, 0);
  EXPECT_GT(squared_error_ratio(solver, samples), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Kernels, Recovery, testing::Values(Kernel::gaussian, Kernel::abel_poisson));

TEST(SliceSolver, GradientFollowsCentralDifferencesOfTheObjective) {
  const SliceSamples samples = samples_of(Kernel::gaussian, three_lobes(), 2000);
  const Progress progress;
  SliceSolver solver(Kernel::gaussian, samples, progress);
  const auto start = disturbed(three_lobes(), 0.1);
  solver.set_lobes(start);
  const auto lobes = solver.lobes();
  const double e = 1e-2;
  AlignedFloats x(samples.padded()), y(x), k(x);
  for (size_t j = 0; j < start.size(); ++j) {
    fill_derivatives(Kernel::gaussian, start[j], samples, x.data(), y.data(), k.data());
    double slope = 0;  // method.md 2.5: dE/dp = -2 sum_c w_c sum_i r_ic peak_jc dS_ij/dp; the peaks are optimal
    for (int c = 0; c < 3; ++c) {
      for (size_t i = 0; i < samples.count(); ++i) {
        slope -= 2 * kLuminance[c] * solver.residual(c)[i] * lobes[j].peak[c] * k[i];
      }
    }
    double objective[2];
    for (const int side : {0, 1}) {
      auto moved = start;
      moved[j].sharpness *= std::exp(side == 0 ? e : -e);
      SliceSolver other(Kernel::gaussian, samples, progress);
      other.set_lobes(moved);
      objective[side] = other.objective();
    }
    EXPECT_NEAR(slope, (objective[0] - objective[1]) / (2 * e), 2e-3 * std::abs(slope) + 1e-7) << j;
  }
}

TEST(SliceSolver, ObjectiveNeverRises) {
  const SliceSamples samples = samples_of(Kernel::gaussian, three_lobes(), 1500);
  const Progress progress;
  SliceSolver solver(Kernel::gaussian, samples, progress);
  solver.set_lobes(disturbed(three_lobes(), 0.3));
  double before = solver.objective();
  for (int step = 0; step < 60; ++step) {
    solver.refine(1, 0, 0);
    EXPECT_LE(solver.objective(), before);
    before = solver.objective();
  }
}

TEST(SliceSolver, TurnsWithItsData) {
  const Mat3 turn = glm::transpose(Mat3(0.36f, 0.48f, -0.8f, -0.8f, 0.6f, 0.0f, 0.48f, 0.64f, 0.6f));
  const Progress progress;
  const SliceSamples plain = samples_of(Kernel::gaussian, three_lobes(), 1500);
  const SliceSamples turned = samples_of(Kernel::gaussian, three_lobes(), 1500, turn);
  SliceSolver a(Kernel::gaussian, plain, progress), b(Kernel::gaussian, turned, progress);
  auto start = disturbed(three_lobes(), 0.1);
  a.set_lobes(start);
  for (LobeShape& s : start) s.center = glm::normalize(glm::dmat3(turn) * s.center);
  b.set_lobes(start);
  a.refine(60, 0, 0);
  b.refine(60, 0, 0);
  for (size_t j = 0; j < 2; ++j) {  // the third is so broad that its center hardly matters
    EXPECT_NEAR(glm::distance(glm::dmat3(turn) * a.shapes()[j].center, b.shapes()[j].center), 0, 1e-4);
    EXPECT_NEAR(a.shapes()[j].sharpness / b.shapes()[j].sharpness, 1, 1e-3);
  }
}

TEST(SliceSolver, NoLobeHidesBetweenSamples) {
  std::vector<SliceSample> bright_one;
  for (const Vec3& w : hemisphere_fibonacci(400)) bright_one.push_back({w, 2 * kPi / 400, Rgb(0.01f)});
  bright_one[57].value = Rgb(100);
  const SliceSamples samples(bright_one);
  const Progress progress;
  SliceSolver solver(Kernel::gaussian, samples, progress);
  solver.set_lobes({{samples.wl(57), 50}});
  solver.refine(100, 0, 0);
  EXPECT_LE(solver.shapes()[0].sharpness, solver.max_sharpness(solver.shapes()[0].center) * (1 + 1e-9));
}

TEST(SliceSolver, ALobeInAHoleIsNoSharperThanItsTailShows) {
  std::vector<SliceSample> around;
  for (const Vec3& w : hemisphere_fibonacci(2000)) {
    if (w.z < 0.8f) around.push_back({w, 2 * kPi / 2000, Rgb(1)});
  }
  const Progress progress;
  const SliceSamples samples(around);
  const SliceSolver solver(Kernel::gaussian, samples, progress);
  EXPECT_NEAR(solver.max_sharpness({0, 0, 1}), std::log(4.0) / 0.2, 0.1);
  EXPECT_GT(solver.max_sharpness({0.8, 0, 0.6}), 500) << "not where there are samples";
}

/// Near the edge of a hole, the spacing of the samples alone allowed peaks a million times what a sample sees.
TEST(SliceSolver, APeakBetweenSamplesIsAtMostFourTimesWhatTheNearestSees) {
  std::vector<SliceSample> around;
  for (const Vec3& w : hemisphere_fibonacci(2000)) {
    if (w.z < 0.97f) around.push_back({w, 2 * kPi / 2000, Rgb(1)});
  }
  const Progress progress;
  const SliceSamples samples(around);
  const SliceSolver solver(Kernel::gaussian, samples, progress);
  const double at_samples = solver.max_sharpness(Vec3d(around[1000].wl));
  size_t far = 0;
  for (const Vec3& w : hemisphere_fibonacci(20000)) {
    const Vec3d center(w);
    double nearest = -1;
    for (const SliceSample& s : around) nearest = std::max(nearest, glm::dot(Vec3d(s.wl), center));
    ASSERT_LT(std::exp(solver.max_sharpness(center) * (1 - nearest)), 4.01) << w.x << ' ' << w.y << ' ' << w.z;
    if (std::exp(at_samples * (1 - nearest)) > 1e6) ++far;
  }
  EXPECT_GT(far, 50u) << "the control: with the sharpness that is allowed at samples";
}

TEST(SliceSolver, TheCosineTermTakesWhatIsDiffuse) {
  std::vector<SliceSample> samples;
  for (const Vec3& w : hemisphere_fibonacci(1000)) {
    const double lobe = shape_value(Kernel::gaussian, {unit(0.5, 0, 0.8), 60}, Vec3d(w));
    samples.push_back({w, 2 * kPi / 1000, Rgb(0.3f, 0.2f, 0.1f) * w.z + Rgb(static_cast<float>(lobe))});
  }
  const SliceSamples slice(samples);
  const Progress progress;
  SliceSolver solver(Kernel::gaussian, slice, progress);
  solver.set_lobes({{unit(0.5, 0.05, 0.8), 40}});
  solver.refine(100, 0, 0);
  EXPECT_LT(glm::distance(solver.diffuse(), Vec3d(0.3, 0.2, 0.1)), 1e-4);
  EXPECT_NEAR(solver.lobes()[0].peak.x, 1, 1e-3);
}

}  // namespace
}  // namespace velour::slice_solver_test

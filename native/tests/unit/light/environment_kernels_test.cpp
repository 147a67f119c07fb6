// The kernels of the sky's fit against a scalar reference in double, on every instruction set.
#include "light/environment_fit.h"

#include <cmath>

#include "math/sphere/directions.h"
#include "math/sphere/random.h"
#include "support/simd_targets.h"

namespace velour::environment_kernels_test {
namespace {

/// More than two blocks, the last one not full: energies over eight decades.
EnvironmentPoints points() {
  EnvironmentPoints p;
  RandomStream random(2, 2, 2);
  for (const Vec3& w : sphere_fibonacci(150)) {
    p.x.push_back(w.x);
    p.y.push_back(w.y);
    p.z.push_back(w.z);
    p.spread.push_back(0.01f * random.next());
    p.energy.push_back(std::pow(random.next(), 8.0f) * 0.02f);
    p.solid_angle.push_back(0.08f + 0.01f * random.next());
    for (auto* channel : {&p.r, &p.g, &p.b}) channel->push_back(p.energy.back() * (0.5f + random.next()));
  }
  return p;
}

EnvironmentLobes lobes() {
  EnvironmentLobes l;
  const auto centers = sphere_fibonacci(7);
  for (size_t k = 0; k < centers.size(); ++k) {
    l.x.push_back(centers[k].x);
    l.y.push_back(centers[k].y);
    l.z.push_back(centers[k].z);
    l.bandwidth.push_back(k == 6 ? 2e3f : 0.5f + 3 * static_cast<float>(k));
    l.share.push_back(1.0f / 7);
    l.peak.push_back(l.share.back() * (0.1f + static_cast<float>(k)));
  }
  return l;
}

double kernel(const EnvironmentPoints& p, size_t i, const Vec3d& center, float bandwidth) {
  const Vec3d offset = Vec3d(p.direction(i)) - center;
  return std::exp(-0.5 * static_cast<double>(bandwidth) * glm::dot(offset, offset));
}

Vec3d center_of(const EnvironmentLobes& l, size_t k) { return {l.x[k], l.y[k], l.z[k]}; }

/// As environment_fit.h defines the moments.
std::vector<EnvironmentMoments> reference(const EnvironmentPoints& p, size_t first, const EnvironmentLobes& l) {
  std::vector<EnvironmentMoments> moments(l.size());
  for (size_t i = first; i < std::min(first + kEnvironmentBlock, p.size()); ++i) {
    std::vector<double> value(l.size());
    double total = 1e-30;
    for (size_t k = 0; k < l.size(); ++k) {
      total += value[k] = static_cast<double>(l.peak[k]) * kernel(p, i, center_of(l, k), l.bandwidth[k]);
    }
    const double e = p.energy[i], expected = std::max(total * static_cast<double>(p.solid_angle[i]), 1e-30);
    const double excess = std::max(e - expected, 0.0), chi = excess * std::min(excess / expected, 1e12);
    for (size_t k = 0; k < l.size(); ++k) {
      const double share = value[k] / total;
      const Vec3d d = Vec3d(p.direction(i)) - center_of(l, k);
      const double q = 0.5 * glm::dot(d, d) + static_cast<double>(p.spread[i]);
      moments[k] += {share * e,         share * e * d.x,   share * e * d.y, share * e * d.z, share * e * q,
                     share * p.r[i],    share * p.g[i],    share * p.b[i],  share * chi,     share * chi * d.x,
                     share * chi * d.y, share * chi * d.z, share * chi * q, share * excess};
    }
  }
  return moments;
}

/// `scale` bounds the terms of the sum.
void expect_near(double found, double expected, double scale) { EXPECT_NEAR(found, expected, 3e-5 * scale + 1e-20); }

TEST(EnvironmentKernels, MomentsMatchTheScalarReferenceOnEveryTarget) {
  const EnvironmentPoints p = points();
  const EnvironmentLobes l = lobes();
  std::vector<float> scratch(kEnvironmentBlock * l.size());
  test::on_every_simd_target([&] {
    for (size_t first = 0; first < p.size(); first += kEnvironmentBlock) {
      std::vector<EnvironmentMoments> found(l.size());
      add_environment_block(p, first, l, scratch.data(), found.data());
      add_environment_block(p, first, l, scratch.data(), found.data());  // it adds
      const std::vector<EnvironmentMoments> expected = reference(p, first, l);
      for (size_t k = 0; k < l.size(); ++k) {
        SCOPED_TRACE(k);
        const EnvironmentMoments &a = found[k], &b = expected[k];
        expect_near(a.energy, 2 * b.energy, b.energy);
        expect_near(a.dx, 2 * b.dx, b.energy);
        expect_near(a.dy, 2 * b.dy, b.energy);
        expect_near(a.dz, 2 * b.dz, b.energy);
        expect_near(a.q, 2 * b.q, b.energy);
        expect_near(a.r, 2 * b.r, b.r);
        expect_near(a.g, 2 * b.g, b.g);
        expect_near(a.b, 2 * b.b, b.b);
        expect_near(a.chi, 2 * b.chi, b.chi);
        expect_near(a.chi_x, 2 * b.chi_x, b.chi);
        expect_near(a.chi_y, 2 * b.chi_y, b.chi);
        expect_near(a.chi_z, 2 * b.chi_z, b.chi);
        expect_near(a.chi_q, 2 * b.chi_q, b.chi);
        expect_near(a.excess, 2 * b.excess, b.excess);
      }
    }
  });
}

TEST(EnvironmentKernels, SmoothingMatchesTheScalarReferenceOnEveryTarget) {
  const EnvironmentPoints p = points();
  test::on_every_simd_target([&] {
    for (const float bandwidth : {0.0f, 1.0f, 200.0f, 1e4f}) {
      for (const Vec3& w : {Vec3(0, 0, 1), p.direction(17), direction(2.2f, -1)}) {
        double expected = 0;
        for (size_t i = 0; i < p.size(); ++i) {
          const float widened = 1 / (1 + p.spread[i] * bandwidth);
          expected += static_cast<double>(p.energy[i] * widened) * kernel(p, i, Vec3d(w), widened * bandwidth);
        }
        EXPECT_NEAR(smoothed_environment(p, w, bandwidth), expected, 1e-5 * expected + 1e-35) << bandwidth;
      }
    }
  });
}

}  // namespace
}  // namespace velour::environment_kernels_test

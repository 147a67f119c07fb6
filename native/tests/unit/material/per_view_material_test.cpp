#include "brdf/eval/per_view_material.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "brdf/eval/per_view_lobes.h"
#include "math/sphere/frame.h"
#include "support/materials.h"
#include "support/mixtures.h"

namespace velour::per_view_material_test {
namespace {

using test::eval_one;
using test::mirror;

std::shared_ptr<const Material> material_of(const PerViewBrdf& brdf, int neighbors = 0) {
  return make_per_view_material(std::make_shared<PerViewBrdf>(brdf), neighbors);
}

float largest_difference(const Rgb& a, const Rgb& b) {
  const Rgb d = glm::abs(a - b);
  return std::max({d.r, d.g, d.b});
}

/// f cos of one slice of the model, in double and without any neighbors.
Rgb slice_value(const PerViewBrdf& brdf, size_t view, const Vec3& wl) {
  Vec3d sum = Vec3d(brdf.diffuse[view]) * static_cast<double>(std::max(wl.z, 0.0f));
  for (uint32_t j = brdf.first_lobe[view]; j < brdf.first_lobe[view + 1]; ++j) {
    sum += kernel_value(brdf.kernel, brdf.bandwidth[j], one_minus_dot(Vec3d(wl), Vec3d(brdf.center[j]))) *
           Vec3d(brdf.coefficient[j]);
  }
  return Rgb(sum);
}

TEST(PerViewMaterial, IsTheSliceAtItsViews) {
  for (const PerViewBrdf& brdf :
       {test::isotropic_model(), test::isotropic_model(Kernel::abel_poisson), test::anisotropic_model()}) {
    const auto material = material_of(brdf);
    for (size_t i = 0; i < brdf.views.size(); i += 7) {
      ScratchArena arena;
      const PreparedBrdf* const point = material->prepare(brdf.views[i], arena);
      for (const Vec3& wl : hemisphere_fibonacci(40)) {
        const Rgb expected = slice_value(brdf, i, wl);
        EXPECT_LT(largest_difference(eval_one(*point, wl).f * wl.z, expected), 1e-4f * (1 + expected.r));
      }
    }
  }
}

TEST(PerViewMaterial, IsZeroBelowTheHorizonAndFiniteEverywhere) {
  const auto material = material_of(test::isotropic_model());
  for (const float theta_v : {0.0f, 0.8f, 1.5f, 1.5707f}) {
    ScratchArena arena;
    const PreparedBrdf* const point = material->prepare(direction(theta_v, 0.3f), arena);
    const Vec3 at_horizon(-1, 0, 0);
    for (const float z : {-1.0f, -1e-3f, -1e-38f, -0.0f, 0.0f}) {
      EXPECT_EQ(eval_one(*point, glm::normalize(Vec3(-1, 0, z))).f, Rgb(0)) << z;
    }
    const Rgb value = eval_one(*point, glm::normalize(at_horizon + Vec3(0, 0, 1e-6f))).f * 1e-6f;
    for (const float z : {1e-45f, 1e-38f, 1e-19f, 1e-9f, 1e-4f}) {
      const auto e = eval_one(*point, at_horizon + Vec3(0, 0, z));
      EXPECT_TRUE(std::isfinite(e.f.r) && std::isfinite(e.f.g) && std::isfinite(e.f.b)) << z;
      EXPECT_GE(e.f.r, 0);
      EXPECT_GT(e.pdf, 0);
      if (z > 1e-20f) {
        EXPECT_NEAR(e.f.r * z, value.r, 0.05f * value.r + 1e-30f) << z;
      }
    }
  }
}

TEST(PerViewMaterial, IsotropicModelsTurnWithBothDirections) {
  const auto material = material_of(test::isotropic_model());
  ASSERT_TRUE(material->isotropic());
  for (const Vec3& wv : hemisphere_fibonacci(20)) {
    for (const Vec3& wl : hemisphere_fibonacci(30)) {
      const float theta_v = std::acos(wv.z), phi = std::atan2(wv.y, wv.x), c = std::cos(phi), s = std::sin(phi);
      const Vec3 turned(c * wl.x + s * wl.y, -s * wl.x + c * wl.y, wl.z);
      const auto e = eval_one(*material, {.wl = wl, .wv = wv});
      const auto expected = eval_one(*material, {.wl = turned, .wv = direction(theta_v, 0)});
      EXPECT_LT(largest_difference(e.f * wl.z, expected.f * wl.z), 2e-3f);
      EXPECT_NEAR(e.pdf, expected.pdf, 2e-3f * (1 + expected.pdf));
    }
  }
}

TEST(PerViewMaterial, TheViewAtThePoleHasAnAzimuth) {
  const auto material = material_of(test::isotropic_model());
  const Vec3 wl = direction(0.4f, 1);
  const auto at_pole = eval_one(*material, {.wl = wl, .wv = {0, 0, 1}});
  EXPECT_TRUE(std::isfinite(at_pole.f.r));
  const auto beside = eval_one(*material, {.wl = wl, .wv = glm::normalize(Vec3(1e-25f, 0, 1))});
  EXPECT_LT(largest_difference(at_pole.f, beside.f), 1e-5f);
}

/// One highlight exactly at each mirror direction.
PerViewBrdf mirror_model(bool isotropic, bool align) {
  PerViewBrdf brdf;
  brdf.isotropic = isotropic;
  brdf.align_views = align;
  brdf.default_neighbors = isotropic ? 2 : 4;
  brdf.views = isotropic ? test::meridian_views() : hemisphere_fibonacci(120);
  brdf.first_lobe = {0};
  for (const Vec3& v : brdf.views) {
    brdf.center.push_back(mirror(v));
    brdf.bandwidth.push_back(2000);
    brdf.coefficient.push_back(Rgb(1));
    brdf.first_lobe.push_back(static_cast<uint32_t>(brdf.center.size()));
  }
  return brdf;
}

// The failure this cures: slices mixed as they are show a sharp highlight at each sampled view's mirror direction, and
// nothing at the query's own.
TEST(PerViewMaterial, AlignedSlicesKeepOneHighlight) {
  for (const bool isotropic : {true, false}) {
    for (const Vec3& wv : {direction(radians_from(42.5f), 0.7f), direction(radians_from(67.5f), -2.0f)}) {
      const float aligned = eval_one(*material_of(mirror_model(isotropic, true)), {.wl = mirror(wv), .wv = wv}).f.g;
      const float plain = eval_one(*material_of(mirror_model(isotropic, false)), {.wl = mirror(wv), .wv = wv}).f.g;
      EXPECT_NEAR(aligned * wv.z, 1, 1e-3f);
      EXPECT_LT(plain * wv.z, 0.6f);
    }
  }
}

TEST(PerViewMaterial, BeyondTheLastViewTheEndSliceFollowsTheMirror) {
  const auto material = material_of(mirror_model(true, true));
  for (const float degrees : {86.0f, 89.0f, 89.9f}) {
    const Vec3 wv = direction(radians_from(degrees), 1.1f);
    EXPECT_NEAR(eval_one(*material, {.wl = mirror(wv), .wv = wv}).f.g * wv.z, 1, 1e-3f) << degrees;
  }
}

TEST(PerViewMaterial, ChangesContinuouslyWithTheView) {
  for (const int neighbors : {1, 2, 3, 4}) {
    for (const PerViewBrdf& brdf : {test::isotropic_model(), test::anisotropic_model()}) {
      if (neighbors == 1) continue;  // the nearest view alone must jump
      const auto material = material_of(brdf, neighbors);
      constexpr int kSteps = 4000;
      const Vec3 wl = direction(0.9f, 2);
      float largest = 0, before = 0, total = 0;
      for (int i = 0; i <= kSteps; ++i) {
        const float s = static_cast<float>(i) / kSteps;
        const float now = eval_one(*material, {.wl = wl, .wv = direction(1.55f * s, 2 + 3 * s)}).f.r;
        if (i > 0) {
          largest = std::max(largest, std::abs(now - before));
          total += std::abs(now - before);
        }
        before = now;
      }
      EXPECT_LT(largest, 0.02f * total) << neighbors;
    }
  }
}

TEST(PerViewMaterial, RefusesMoreLobesThanCanBeMixed) {
  PerViewBrdf brdf = test::isotropic_model();
  for (const int neighbors : {-1, 9, 1000}) {
    EXPECT_THROW(material_of(brdf, neighbors), Error) << neighbors;
  }
  brdf.views = {{0, 0, 1}};
  constexpr uint32_t kLobes = LobeMixture::kCapacity / 2 + 1;
  brdf.center.assign(kLobes, {0, 0, 1});
  brdf.bandwidth.assign(kLobes, 5);
  brdf.coefficient.assign(kLobes, Rgb(1));
  brdf.first_lobe = {0, kLobes};
  EXPECT_THROW(material_of(brdf, 2), Error);
  EXPECT_NO_THROW(material_of(brdf, 1));
}

/// Luminance of f cos over the sphere, of the model's lobes and of the few that stand for them.
TEST(PerViewMaterial, ProposesFewLobesOfTheSameEnergyAndDirection) {
  for (const PerViewBrdf& brdf :
       {test::isotropic_model(), test::isotropic_model(Kernel::abel_poisson), test::anisotropic_model()}) {
    const auto material = material_of(brdf);
    for (size_t i = 0; i < brdf.views.size(); i += 5) {
      ScratchArena arena;
      const PreparedBrdf* const point = material->prepare(brdf.views[i], arena);
      ProposalLobes few;
      ASSERT_TRUE(point->proposal_lobes(few));
      EXPECT_LE(few.count, ProposalLobes::kCapacity);
      EXPECT_FLOAT_EQ(few.cosine, luminance(brdf.diffuse[i]));
      Vec3d whole(0), proposed(0);
      double energy = 0, proposed_energy = 0;
      for (uint32_t j = brdf.first_lobe[i]; j < brdf.first_lobe[i + 1]; ++j) {
        const auto l = static_cast<double>(brdf.bandwidth[j]);
        const double mass = static_cast<double>(luminance(brdf.coefficient[j])) * kernel_integral(brdf.kernel, l);
        energy += mass;
        whole += mass * (brdf.kernel == Kernel::gaussian ? 1 - gaussian_one_minus_mean(l) : l) * Vec3d(brdf.center[j]);
      }
      for (int j = 0; j < few.count; ++j) {
        const auto l = static_cast<double>(few.lobe[j].bandwidth);
        const double mass = static_cast<double>(few.lobe[j].amplitude) * kernel_integral(Kernel::gaussian, l);
        proposed_energy += mass;
        proposed += mass * (1 - gaussian_one_minus_mean(l)) * Vec3d(few.lobe[j].center);
      }
      EXPECT_NEAR(proposed_energy, energy, 1e-5 * energy);
      EXPECT_LT(glm::length(proposed - whole), 1e-4 * energy) << i;
    }
  }
}

TEST(PerViewMaterial, ProposalsFollowTheViewsMirror) {
  PerViewBrdf brdf = test::isotropic_model();
  brdf.align_views = true;
  const auto material = material_of(brdf);
  ScratchArena arena;
  ProposalLobes at_view, turned;
  ASSERT_TRUE(material->prepare(brdf.views[3], arena)->proposal_lobes(at_view));
  const Vec3 wv = direction(std::acos(brdf.views[3].z) + 1e-3f, 1.0f);
  ASSERT_TRUE(material->prepare(wv, arena)->proposal_lobes(turned));
  ASSERT_EQ(turned.count, at_view.count);
  const Mat3 rotation = rotation_between(mirror(brdf.views[3]), mirror(direction(std::acos(wv.z), 0.0f)));
  for (int j = 0; j < turned.count; ++j) {
    const Vec3 c = rotation * at_view.lobe[j].center;
    const Vec3 expected(std::cos(1.0f) * c.x - std::sin(1.0f) * c.y, std::sin(1.0f) * c.x + std::cos(1.0f) * c.y, c.z);
    EXPECT_LT(glm::length(turned.lobe[j].center - expected), 1e-4f);
  }
}

/// The density of a slice alone [T09 7.9], with the cosine's share for what lobes miss.
double slice_density(const PerViewBrdf& brdf, size_t view, const Vec3& wl) {
  double mass = kPiD * static_cast<double>(luminance(brdf.diffuse[view])), sum = 0;
  const double cosine = static_cast<double>(std::max(wl.z, 0.0f));
  for (uint32_t j = brdf.first_lobe[view]; j < brdf.first_lobe[view + 1]; ++j) {
    const auto strength = static_cast<double>(luminance(brdf.coefficient[j]));
    mass += strength * kernel_integral(brdf.kernel, static_cast<double>(brdf.bandwidth[j]));
    sum += strength * kernel_value(brdf.kernel, brdf.bandwidth[j], one_minus_dot(Vec3d(wl), Vec3d(brdf.center[j])));
  }
  sum += static_cast<double>(luminance(brdf.diffuse[view])) * cosine;
  return 0.95 * sum / mass + 0.05 * cosine / kPiD;
}

TEST(InterpolatedViews, AtAViewAreItsOwnDensity) {
  for (const PerViewBrdf& brdf :
       {test::isotropic_model(), test::isotropic_model(Kernel::abel_poisson), test::anisotropic_model()}) {
    const auto material = material_of(brdf);
    ScratchArena arena;
    for (size_t i = 0; i < brdf.views.size(); i += 7) {
      arena.reset();
      const PreparedBrdf* const point = material->prepare(brdf.views[i], {}, {.interpolated_draws = true}, arena);
      for (const Vec3& wl : hemisphere_fibonacci(40)) {
        const double expected = slice_density(brdf, i, wl);
        EXPECT_NEAR(static_cast<double>(eval_one(*point, wl).pdf), expected, 1e-3 * (expected + 0.01));
      }
    }
  }
}

/// Four on any set of views, or as many as are asked for, each by its weight.
TEST(InterpolatedViews, AreTheFourNearest) {
  for (const PerViewBrdf& brdf : {test::isotropic_model(), test::anisotropic_model()}) {
    const Vec3 wv = glm::normalize(brdf.views[9] + 0.3f * brdf.views[10]);
    for (const int asked : {0, 3}) {
      const auto placed = PerViewLobes(brdf, asked).place_nearest(wv);
      ASSERT_EQ(placed.views.count, asked == 0 ? 4 : asked);
      std::vector<float> angle;
      for (const Vec3& view : brdf.views) angle.push_back(std::acos(std::min(glm::dot(view, wv), 1.0f)));
      std::vector<float> sorted = angle;
      std::ranges::sort(sorted);
      for (int i = 0; i < placed.views.count; ++i) {
        EXPECT_LE(angle[static_cast<size_t>(placed.views.index[i])],
                  sorted[static_cast<size_t>(placed.views.count) - 1] + 1e-4f);
      }
    }
  }
}

TEST(PerViewMaterial, WithoutLobesSamplesTheCosine) {
  for (const bool isotropic : {true, false}) {
    PerViewBrdf brdf;
    brdf.isotropic = isotropic;
    brdf.first_lobe = {0};
    const auto material = material_of(brdf);
    const auto e = eval_one(*material, {.wl = direction(1, 0), .wv = direction(0.5f, 0)});
    EXPECT_EQ(e.f, Rgb(0));
    EXPECT_NEAR(e.pdf, std::cos(1.0f) / kPi, 0.01);
  }
}

}  // namespace
}  // namespace velour::per_view_material_test

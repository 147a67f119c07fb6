#include "brdf/eval/parametric_material.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/materials.h"
#include "support/mixtures.h"
#include "support/parametric_models.h"
#include "support/simd_targets.h"

namespace velour::parametric_material_test {
namespace {

using test::eval_one;
using test::LobeRecipe;
using P = ParametricBrdf;

std::shared_ptr<const Material> material_of(const ParametricBrdf& brdf) {
  return make_parametric_material(std::make_shared<ParametricBrdf>(brdf));
}

/// What the material computes, in double from the model's definition, and the error that float directions excuse.
struct Reference {
  Vec3d f{0};
  double allowed = 0;
};

Reference reference(const std::vector<WarpedLobe>& lobes, const Vec3& wl, const Vec3& wv) {
  Reference result;
  if (wl.z <= 0) return result;
  for (const WarpedLobe& lobe : lobes) {
    const Vec3d value = lobe.coefficient * warped_kernel(lobe, Vec3d(wl), Vec3d(wv));
    const double exponent = lobe.bandwidth * one_minus_dot(warped(lobe, Vec3d(wl), Vec3d(wv)), lobe.center);
    const double length = lobe.space == LobeSpace::half ? glm::length(Vec3d(wl) + Vec3d(wv)) : 1;
    const double shift = 2e-6 + 5e-7 / length;  // of psi, radians
    result.f += value;
    result.allowed += value.y * (3e-5 + 3e-5 * exponent + shift * std::sqrt(2 * lobe.bandwidth * exponent) +
                                 0.5 * shift * shift * lobe.bandwidth);
  }
  return result;
}

/// Directions that the lobes are near to, and others.
std::vector<Vec3> directions_about(const std::vector<WarpedLobe>& lobes, const Vec3& wv) {
  std::vector<Vec3> set = hemisphere_fibonacci(20);
  RandomStream random(3, 1, 4);
  for (const WarpedLobe& lobe : lobes) {
    for (int i = 0; i < 8; ++i) {
      const double width = 2 * random.next() / std::sqrt(lobe.bandwidth + 1);
      const Vec3d offset(random.next() - 0.5f, random.next() - 0.5f, random.next() - 0.5f);
      const auto wl = unwarped(lobe, glm::normalize(lobe.center + width * offset), Vec3d(wv));
      if (wl) set.emplace_back(*wl);
    }
  }
  return set;
}

const float kBandwidths[] = {1e-4f, 0.1f, 10, 1e3f, 1e5f, 1e6f};
const float kAngles[] = {0, 1, 5, 30, 60, 75, 85, 89.5f, 89.9f};

void expect_is_the_model(const ParametricBrdf& brdf, const Material& material, const Vec3& wv) {
  const auto lobes = lobes_at(brdf, Vec3d(wv));
  ScratchArena arena;
  const PreparedBrdf* const point = material.prepare(wv, arena);
  const auto set = directions_about(lobes, wv);
  for (const size_t size : {size_t{1}, size_t{2}, size_t{5}, size_t{33}}) {
    for (size_t first = 0; first + size <= set.size(); first += size) {
      const DirectionBatch wl = test::batch_of({set.data() + first, size});
      RgbBatch f;
      ScalarBatch pdf;
      point->eval(wl, f, pdf);
      for (int i = 0; i < wl.count; ++i) {
        const Reference expected = reference(lobes, wl.get(i), wv);
        ASSERT_NEAR(f.g[i], expected.f.y, expected.allowed + 1e-35) << size << ' ' << first << ' ' << i;
        ASSERT_NEAR(f.r[i] * expected.f.y, expected.f.x * f.g[i], 3e-5 * f.r[i] * expected.f.y + 1e-30);
        ASSERT_TRUE(std::isfinite(pdf.v[i]) && pdf.v[i] >= 0) << pdf.v[i];
        ASSERT_TRUE(pdf.v[i] > 0 || wl.z[i] < 0);
      }
    }
  }
}

TEST(ParametricMaterial, IsTheModelAtEveryView) {
  test::on_every_simd_target([] {
    for (const bool isotropic : {true, false}) {
      for (const float bandwidth : kBandwidths) {
        const ParametricBrdf brdf = test::parametric_model(isotropic, test::highlight_recipe(bandwidth));
        const auto material = material_of(brdf);
        for (const float degrees : kAngles) {
          SCOPED_TRACE(std::to_string(isotropic) + " bandwidth " + std::to_string(bandwidth) + " view " +
                       std::to_string(degrees));
          expect_is_the_model(brdf, *material, direction(radians_from(degrees), 0.7f));
        }
      }
    }
  });
}

TEST(ParametricMaterial, AnyNumberOfLobes) {
  for (const int count : {0, 1, 7, 8, 9, 17, 32}) {
    std::vector<LobeRecipe> lobes;
    for (int j = 0; j < count; ++j) {
      const auto k = static_cast<float>(j);
      lobes.push_back(
          {j % 2 ? LobeSpace::half : LobeSpace::light, 1 + 3 * k, Rgb(0.1f + 0.01f * k), 0.02f * k, 0.01f * k});
    }
    const ParametricBrdf brdf = test::parametric_model(true, lobes);
    expect_is_the_model(brdf, *material_of(brdf), direction(0.9f, -2));
  }
  const std::vector<LobeRecipe> many(33, {LobeSpace::light, 1, Rgb(1)});
  EXPECT_THROW(material_of(test::parametric_model(true, many)), Error);
}

TEST(ParametricMaterial, IsZeroBelowTheHorizonAndFiniteEverywhere) {
  for (const bool isotropic : {true, false}) {
    for (const float bandwidth : kBandwidths) {
      const auto material = material_of(test::parametric_model(isotropic, test::highlight_recipe(bandwidth)));
      for (const float theta_v : {0.0f, 0.8f, 1.5f, 1.5707f}) {
        ScratchArena arena;
        const Vec3 wv = direction(theta_v, 0.3f);
        const PreparedBrdf* const point = material->prepare(wv, arena);
        for (const float z : {-1.0f, -1e-3f, -1e-38f, -0.0f, 0.0f}) {
          EXPECT_EQ(eval_one(*point, glm::normalize(Vec3(-1, 0, z))).f, Rgb(0)) << z;
        }
        EXPECT_TRUE(std::isfinite(eval_one(*point, -wv).pdf));
        for (const float z : {1e-45f, 1e-38f, 1e-9f, 1e-4f}) {
          const auto e = eval_one(*point, Vec3(-std::cos(0.3f), -std::sin(0.3f), z));
          EXPECT_TRUE(std::isfinite(e.f.r) && e.f.r >= 0 && std::isfinite(e.pdf) && e.pdf > 0) << z;
        }
      }
    }
  }
}

TEST(ParametricMaterial, BlackLobesLeaveTheCosine) {
  ParametricBrdf brdf = test::parametric_model(true, test::highlight_recipe(100));
  for (int node = 0; node < brdf.spline().node_count(); ++node) {
    for (int j = 0; j < brdf.lobe_count(); ++j) {
      for (const int k : {P::kLogRed, P::kLogGreen, P::kLogBlue}) brdf.control[brdf.index(node, k, j)] = -500;
    }
  }
  const auto e = eval_one(*material_of(brdf), {.wl = direction(0.4f, 1), .wv = direction(0.8f, 0)});
  EXPECT_EQ(e.f, Rgb(0));
  EXPECT_NEAR(e.pdf, std::cos(0.4f) / kPi, 0.01f);
}

TEST(ParametricMaterial, IsotropicModelsTurnWithBothDirections) {
  const auto material = material_of(test::parametric_model(true, test::highlight_recipe(300)));
  ASSERT_TRUE(material->isotropic());
  for (const Vec3& wv : hemisphere_fibonacci(20)) {
    for (const Vec3& wl : hemisphere_fibonacci(30)) {
      const float theta_v = std::acos(wv.z), phi = std::atan2(wv.y, wv.x), c = std::cos(phi), s = std::sin(phi);
      const Vec3 turned(c * wl.x + s * wl.y, -s * wl.x + c * wl.y, wl.z);
      const auto e = eval_one(*material, {.wl = wl, .wv = wv});
      const auto expected = eval_one(*material, {.wl = turned, .wv = direction(theta_v, 0)});
      EXPECT_NEAR(e.f.g, expected.f.g, 1e-4f * expected.f.g);
      EXPECT_NEAR(e.pdf, expected.pdf, 1e-4f * expected.pdf);
    }
  }
}

/// Largest second difference of f over views 0.1 degrees apart, across the normal, relative to the largest f.
double largest_bend(const Material& material, const Vec3& wl, float azimuth) {
  std::vector<double> f;
  for (int i = -850; i <= 850; ++i) {
    const float theta = radians_from(0.1f * static_cast<float>(i));
    f.push_back(static_cast<double>(eval_one(material, {.wl = wl, .wv = direction(theta, azimuth)}).f.g));
  }
  double bend = 0;
  for (size_t i = 1; i + 1 < f.size(); ++i) bend = std::max(bend, std::abs(f[i - 1] - 2 * f[i] + f[i + 1]));
  return bend / *std::max_element(f.begin(), f.end());
}

// exp(-lambda theta^2 / 2) bends by lambda at its peak; in half space theta is half the angle of the view, and the
// stretch narrows the lobe by 3 at most. A second highlight, a jump or a kink of a tenth of the value would bend by a
// tenth and more.
TEST(ParametricMaterial, IsContinuousInTheView) {
  const double step = radians_from(0.1);
  for (const bool isotropic : {true, false}) {
    for (const float bandwidth : {30.0f, 3000.0f}) {
      const auto material = material_of(test::parametric_model(isotropic, test::highlight_recipe(bandwidth)));
      const double allowed = (1.5 * 3 * static_cast<double>(bandwidth) / 4 + 60) * step * step;
      for (const float azimuth : {0.0f, 0.6f, 2.0f}) {
        for (const float theta_l : {0.0f, 0.02f, 0.5f, 1.2f}) {
          EXPECT_LT(largest_bend(*material, direction(theta_l, 1.1f), azimuth), allowed)
              << isotropic << ' ' << bandwidth << ' ' << azimuth << ' ' << theta_l;
        }
      }
    }
  }
}

/// Luminance of f cos by the proposals.
double proposed(const ProposalLobes& lobes, const Vec3& wl) {
  double sum = lobes.cosine * std::max(wl.z, 0.0f);
  for (int j = 0; j < lobes.count; ++j) {
    const GaussianLobe& lobe = lobes.lobe[j];
    sum +=
        lobe.amplitude * kernel_value(Kernel::gaussian, lobe.bandwidth, one_minus_dot(Vec3d(wl), Vec3d(lobe.center)));
  }
  return sum;
}

TEST(ParametricMaterial, ProposalsResembleTheModel) {
  for (const bool isotropic : {true, false}) {
    const auto material = material_of(test::parametric_model(isotropic, test::highlight_recipe(40)));
    for (const float degrees : {0.0f, 20.0f, 45.0f, 60.0f}) {
      ScratchArena arena;
      const Vec3 wv = direction(radians_from(degrees), 2.2f);
      const PreparedBrdf* const point = material->prepare(wv, arena);
      ProposalLobes lobes;
      ASSERT_TRUE(point->proposal_lobes(lobes));
      double difference = 0, whole = 0;
      for (const Vec3& wl : hemisphere_fibonacci(2000)) {
        const double f_cos = luminance(eval_one(*point, wl).f) * wl.z;
        difference += std::abs(proposed(lobes, wl) - f_cos);
        whole += f_cos;
      }
      EXPECT_LT(difference, 0.4 * whole) << isotropic << ' ' << degrees;
    }
  }
}

TEST(ParametricMaterial, SymmetricOnesAreReciprocalAndTheMeanOfBothOrders) {
  for (const bool isotropic : {true, false}) {
    ParametricBrdf brdf = test::parametric_model(isotropic, test::highlight_recipe(20));
    brdf.symmetric = true;
    const auto symmetric = material_of(brdf);
    RandomStream random(5, 2, 1);
    for (int i = 0; i < 200; ++i) {
      const Vec3 a = direction(1.5f * random.next(), 6 * random.next()),
                 b = direction(1.5f * random.next(), 6 * random.next());
      const Vec3d expected = value_of(brdf, Vec3d(a), Vec3d(b));
      const auto there = eval_one(*symmetric, {a, b}), back = eval_one(*symmetric, {b, a});
      EXPECT_NEAR(there.f.g, back.f.g, 1e-5f * there.f.g) << i;
      EXPECT_NEAR(static_cast<double>(there.f.g), expected.y, 2e-3 * expected.y + 1e-6) << i;
    }
  }
}

}  // namespace
}  // namespace velour::parametric_material_test

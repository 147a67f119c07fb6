#include "support/sampler_proof.h"

#include "math/sphere/directions.h"

namespace velour::test {

ChiSquareOptions proof_options(const Sampler& sampler) {
  ChiSquareOptions options;
  options.rows = 25;
  options.columns = 16;
  options.axis = sampler.axis;
  options.concentration = sampler.concentration;
  options.refinements = sampler.refinements;
  options.may_fail = sampler.may_fail;
  options.samples = 200'000;
  options.seed = seed_of_test();
  return options;
}

void expect_proven(const Sampler& sampler, const std::string& name) {
  EXPECT_TRUE(follows_density(chi_square(sampler.sample, sampler.pdf, proof_options(sampler)), suite_level(), name));
  constexpr float kLast = 1 - 0x1p-24f;
  for (const float a : {0.0f, 0x1p-24f, 0.5f, kLast}) {
    for (const float b : {0.0f, 0x1p-24f, 0.5f, kLast}) {
      const Vec3 w = sampler.sample({a, b});
      if (sampler.may_fail && w == Vec3(0)) continue;
      const double density = sampler.pdf(w);
      EXPECT_NEAR(glm::length(w), 1, 2e-6f) << name << " at " << a << ' ' << b;
      EXPECT_TRUE(std::isfinite(density) && density >= 0) << name << " at " << a << ' ' << b << ": " << density;
    }
  }
}

double p_value(const Sampler& sampled, const Sampler& claimed) {
  return chi_square(sampled.sample, claimed.pdf, proof_options(sampled)).p_value;
}

Vec3 view_at(float degrees) { return direction(radians_from(degrees), 0.7f); }

}  // namespace velour::test

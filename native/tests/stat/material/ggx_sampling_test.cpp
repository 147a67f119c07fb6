#include "judge.h"
#include "material/ggx_sampler.h"
#include "support/statistics.h"

namespace velour {
namespace {

using test::judge;
using test::quick_options;

GgxParameters lobe(const Vec2& alpha, float diffuse) {
  return {.alpha = alpha, .f0 = Rgb(0.5f), .f90 = Rgb(1), .diffuse = Rgb(diffuse)};
}

std::vector<GgxParameters> judged_lobes() {
  return {lobe(Vec2(0.15f), 0), lobe(Vec2(0.5f), 0.3f), lobe({0.15f, 0.5f}, 0.1f), lobe({0.9f, 0.3f}, 0),
          lobe(Vec2(2), 0)};
}

TEST(GgxSampling, FollowsItsDensity) {
  const auto views = test::judged_views();
  const double level = test::sidak_level(0.01, static_cast<int>(judged_lobes().size() * views.size()));
  uint64_t seed = 500;
  for (const GgxParameters& p : judged_lobes()) {
    const auto material = make_ggx_material(p);
    for (const Vec3& wv : views) {
      test::expect_accepted(judge(*material, *material, wv, quick_options(++seed)), level,
                            std::to_string(p.alpha.x) + " at cosine " + std::to_string(wv.z));
    }
  }
}

// A lobe of a tenth of a degree, in cells that are logarithmic in the distance from the mirror direction.
TEST(GgxSampling, FollowsItsDensityNearAMirror) {
  const auto material = make_ggx_material(lobe({1e-3f, 3e-3f}, 0));
  for (const float degrees : {0.0f, 45.0f, 70.0f}) {
    const Vec3 wv = direction(radians_from(degrees), 1.3f);
    test::ChiSquareOptions options = quick_options(8);
    options.axis = test::mirror(wv);
    options.concentration = 1e5;
    test::expect_accepted(judge(*material, *material, wv, options), test::sidak_level(0.01, 3),
                          std::to_string(degrees));
  }
}

TEST(GgxSampling, RejectsAnotherRoughnessAndAnotherShare) {
  const Vec3 wv = direction(radians_from(45.0f), 0.7f);
  test::ChiSquareOptions options = quick_options(2);
  options.axis = test::mirror(wv);
  options.concentration = 100;
  options.phi_cells = 8;
  options.samples = 1'000'000;
  const auto sampled = make_ggx_material(lobe({0.2f, 0.4f}, 0.1f));
  const auto rejected = [&](const GgxParameters& claimed) {
    return judge(*sampled, *make_ggx_material(claimed), wv, options).p_value < 1e-6;
  };
  EXPECT_FALSE(rejected(lobe({0.2f, 0.4f}, 0.1f)));
  EXPECT_TRUE(rejected(lobe({0.21f, 0.4f}, 0.1f)));
  EXPECT_TRUE(rejected(lobe({0.2f, 0.42f}, 0.1f)));
  EXPECT_TRUE(rejected(lobe({0.2f, 0.4f}, 0.11f)));
}

}  // namespace
}  // namespace velour

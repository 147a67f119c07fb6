#include "math/sphere/warp.h"
#include "support/sampler_proof.h"

namespace velour::warp_sampling_test {
namespace {

struct Warp {
  const char* name;
  Vec3 (*sample)(const Vec2&);
  float (*pdf)(const Vec3&);
};

class WarpSampling : public ::testing::TestWithParam<Warp> {};

TEST_P(WarpSampling, FollowsItsDensity) {
  const Warp& warp = GetParam();
  test::expect_proven({warp.sample, warp.pdf}, warp.name);
}

INSTANTIATE_TEST_SUITE_P(
    All, WarpSampling,
    ::testing::Values(Warp{"uniform_hemisphere", sample_uniform_hemisphere, pdf_uniform_hemisphere},
                      Warp{"uniform_sphere", sample_uniform_sphere, [](const Vec3&) { return 0.25f / kPi; }},
                      Warp{"cosine", sample_cosine_hemisphere, pdf_cosine_hemisphere}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(WarpControl, TheCosineIsNotUniform) {
  EXPECT_LT(test::p_value({sample_uniform_hemisphere, pdf_uniform_hemisphere},
                          {sample_cosine_hemisphere, pdf_cosine_hemisphere}),
            1e-9);
}

}  // namespace
}  // namespace velour::warp_sampling_test

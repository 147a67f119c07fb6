#include "base/simd.h"

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include "support/mixtures.h"

namespace velour::simd_target_test {
namespace {

class SimdTarget : public ::testing::Test {
 protected:
  void TearDown() override { select_simd_target("auto"); }
};

TEST_F(SimdTarget, PinsAndLifts) {
  const auto targets = simd_targets();
  ASSERT_FALSE(targets.empty());
  EXPECT_EQ(simd_target(), targets.front());
  for (const std::string& target : targets) {
    EXPECT_TRUE(select_simd_target(target.c_str()));
    EXPECT_EQ(simd_target(), target);
    EXPECT_EQ(simd_targets(), targets);
  }
  EXPECT_TRUE(select_simd_target("auto"));
  EXPECT_EQ(simd_target(), targets.front());
}

TEST_F(SimdTarget, RefusesAnUnknownNameAndKeepsItsChoice) {
  for (const std::string& target : simd_targets()) {
    ASSERT_TRUE(select_simd_target(target.c_str()));
    EXPECT_FALSE(select_simd_target("MMX"));
    EXPECT_FALSE(select_simd_target(""));
    EXPECT_EQ(simd_target(), target);
  }
}

/// Highway's own answer, from its library, which ours does not link.
TEST_F(SimdTarget, DetectsWhatHighwayDetects) {
  void* library = dlopen("libhwy.so.1", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) GTEST_SKIP() << "Highway's library is not installed";
  const auto oracle = reinterpret_cast<int64_t (*)()>(dlsym(library, "_ZN3hwy16SupportedTargetsEv"));
  ASSERT_NE(oracle, nullptr);
  ASSERT_NE(oracle, &hwy::SupportedTargets);
  EXPECT_EQ(hwy::SupportedTargets() & HWY_TARGETS, oracle() & HWY_TARGETS);
  dlclose(library);
}

// Fused and separate multiply-adds round differently; nothing else may differ.
TEST_F(SimdTarget, AllTargetsAgreeWithinRounding) {
  for (const Kernel kernel : {Kernel::gaussian, Kernel::abel_poisson}) {
    const LobeMixture mixture = test::random_mixture(kernel, 20, 5);
    const DirectionBatch batch = test::batch_of(sphere_fibonacci(64));
    RgbBatch expected, value;
    ScalarBatch expected_pdf, pdf;
    select_simd_target("auto");
    eval_mixture(mixture, batch, expected, expected_pdf);
    for (const std::string& target : simd_targets()) {
      ASSERT_TRUE(select_simd_target(target.c_str()));
      eval_mixture(mixture, batch, value, pdf);
      for (int i = 0; i < batch.count; ++i) {
        EXPECT_NEAR(value.g[i], expected.g[i], 3e-5f * expected.g[i] + 1e-30f) << target << ' ' << i;
        EXPECT_NEAR(pdf.v[i], expected_pdf.v[i], 3e-5f * expected_pdf.v[i] + 1e-30f) << target << ' ' << i;
      }
    }
  }
}

}  // namespace
}  // namespace velour::simd_target_test

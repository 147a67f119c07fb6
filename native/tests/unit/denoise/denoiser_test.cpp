// Open Image Denoise: found by name or named in a sentence, and what it makes of noise.
#include "denoise/denoiser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

#include "math/sphere/random.h"

namespace velour::denoiser_test {
namespace {

constexpr int kWidth = 67, kHeight = 45;
constexpr size_t kCount = size_t{3} * kWidth * kHeight;

class DenoiserTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const char* file = std::getenv("VELOUR_OIDN")) set_open_image_denoise_file(file);
    try {
      open_image_denoise();
    } catch (const Error& error) {
      GTEST_SKIP() << error.what();
    }
    for (size_t i = 0; i < kCount; ++i) {
      const float noise = RandomStream(1, i, 0).next();
      noisy_.push_back(2 * noise);
      albedo_.push_back(0.5f);
      normal_.push_back(i % 3 == 2 ? 1.0f : 0.0f);
    }
  }

  NoisyPicture picture() const { return {kWidth, kHeight, noisy_, albedo_, normal_}; }
  std::vector<float> denoised(int threads) const {
    std::vector<float> out(kCount);
    Denoiser(threads).run(picture(), out, Progress{});
    return out;
  }

  std::vector<float> noisy_, albedo_, normal_;
};

double spread(const std::vector<float>& values) {
  double sum = 0, squares = 0;
  for (const auto v : values) {
    sum += static_cast<double>(v);
    squares += static_cast<double>(v) * static_cast<double>(v);
  }
  const double mean = sum / static_cast<double>(values.size());
  return std::sqrt(squares / static_cast<double>(values.size()) - mean * mean);
}

TEST_F(DenoiserTest, TakesNoiseAndKeepsTheMean) {
  const auto out = denoised(2);
  EXPECT_LT(spread(out), 0.2 * spread(noisy_));
  double mean = 0;
  for (const float v : out) mean += static_cast<double>(v) / static_cast<double>(kCount);
  EXPECT_NEAR(mean, 1.0, 0.05);
}

TEST_F(DenoiserTest, TakesNoiseWithLittleEffort) {
  std::vector<float> out(kCount);
  Denoiser(2, Denoiser::Effort::least).run(picture(), out, Progress{});
  EXPECT_LT(spread(out), 0.3 * spread(noisy_));
}

TEST_F(DenoiserTest, HasTheSameBitsForAnyNumberOfThreads) { EXPECT_EQ(denoised(1), denoised(2)); }

TEST_F(DenoiserTest, SaysWhatItIs) {
  const Denoiser denoiser(1);
  EXPECT_EQ(denoiser.version()[0], '2');
  EXPECT_NE(denoiser.path().find("OpenImageDenoise"), std::string::npos);
}

TEST_F(DenoiserTest, RefusesAPictureOfAnotherSizeAndStopsWhenAsked) {
  std::vector<float> out(kCount - 3);
  EXPECT_THROW(Denoiser(1).run(picture(), out, Progress{}), Error);
  out.resize(kCount);
  Progress cancelled;
  cancelled.cancel();
  try {
    Denoiser(1).run(picture(), out, cancelled);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::cancelled);
  }
}

TEST(PrivateLibrary, NamesWhatItTried) {
  try {
    const PrivateLibrary missing("libNoDenoise.so.2", "scripts/setup --denoise installs it.",
                                 "/nowhere/libNoDenoise.so");
    FAIL() << missing.path();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::unsupported);
    EXPECT_NE(std::string(error.what()).find("/nowhere/"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("scripts/setup --denoise"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace velour::denoiser_test

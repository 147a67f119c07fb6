// The error that two halves tell of a denoised picture, with a filter whose true error is known: the mean over
// neighbors.
#include "denoise/denoiser.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "math/sphere/random.h"

namespace velour::halves_test {
namespace {

constexpr int kSide = 48;
constexpr size_t kPixels = kSide * kSide;
using Picture = std::vector<float>;  // 3 floats a pixel

Picture truth() {
  Picture picture;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const float value = 1 + std::sin(0.5f * static_cast<float>(x)) * std::cos(0.3f * static_cast<float>(y));
      picture.insert(picture.end(), {value, 0.5f * value, x > kSide / 2 ? 3.0f : 0.2f});
    }
  }
  return picture;
}

/// Means of `rays` samples: nearly always a little too dark, and rarely far too bright.
Picture samples(uint64_t seed, uint32_t half, const std::vector<uint32_t>& rays, float noise) {
  Picture picture = truth();
  for (size_t i = 0; i < picture.size(); ++i) {
    const uint32_t all = rays[i / 3], count = half == 0 ? all - all / 2 : all / 2;
    RandomStream random(seed, i, half);
    float sum = 0;
    for (uint32_t k = 0; k < count; ++k) sum += random.next() < 0.02f ? 1 + 7 * noise : 1 - 7 * noise * (0.02f / 0.98f);
    picture[i] *= sum / static_cast<float>(count);
  }
  return picture;
}

/// Over `radius` to each side.
Picture blurred(const Picture& picture, int radius) {
  Picture out(picture.size());
  const auto at = [](int x, int y, int c) {
    return static_cast<size_t>(3 * (std::clamp(y, 0, kSide - 1) * kSide + std::clamp(x, 0, kSide - 1)) + c);
  };
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      for (int c = 0; c < 3; ++c) {
        float sum = 0;
        for (int j = -radius; j <= radius; ++j) {
          for (int i = -radius; i <= radius; ++i) sum += picture[at(x + i, y + j, c)];
        }
        out[at(x, y, c)] = sum / static_cast<float>((2 * radius + 1) * (2 * radius + 1));
      }
    }
  }
  return out;
}

/// Relative to `relative_to`, as PictureDifference is to the true picture.
double error_of(const Picture& picture, const Picture& relative_to) {
  const Picture right = truth();
  double mean = 0, sum = 0;
  for (const float r : relative_to) mean += static_cast<double>(r) / static_cast<double>(right.size());
  for (size_t i = 0; i < right.size(); ++i) {
    const auto x = static_cast<double>(picture[i]), r = static_cast<double>(relative_to[i]);
    const auto off = x - static_cast<double>(right[i]);
    sum += off * off / (r * r + 0.01 * mean * mean);
  }
  return sum / static_cast<double>(right.size());
}

struct Trial {
  DenoisedError stated;
  double same;  // relative to the denoised picture, as what is stated
  double real;
};

/// `shared`: how much of the first half the second one repeats.
Trial trial(uint64_t seed, const std::vector<uint32_t>& rays, int radius = 1, float shared = 0) {
  const Picture first = samples(seed, 0, rays, 0.5f);
  Picture second = samples(seed, 1, rays, 0.5f);
  for (size_t i = 0; i < second.size(); ++i) second[i] += shared * (first[i] - second[i]);
  const Picture of_first = blurred(first, radius), of_second = blurred(second, radius);
  Picture picture(first.size());
  const DenoisedError stated = combine({{first, second}, {of_first, of_second}, rays}, picture);
  Picture mean(first.size());
  for (size_t i = 0; i < mean.size(); ++i) mean[i] = 0.5f * (of_first[i] + of_second[i]);
  return {stated, error_of(picture, mean), error_of(picture, truth())};
}

struct Verdict {
  double z;  // of the mean difference of stated and real errors
  int covered, trials;
};

Verdict judge(const std::vector<uint32_t>& rays, float shared = 0) {
  constexpr int kTrials = 60;
  double sum = 0, squares = 0;
  Verdict verdict{0, 0, kTrials};
  for (uint64_t seed = 0; seed < kTrials; ++seed) {
    const Trial t = trial(seed, rays, 1, shared);
    const double difference = t.stated.relmse - t.same;
    sum += difference;
    squares += difference * difference;
    verdict.covered += t.same <= t.stated.relmse + 2 * t.stated.standard_error ? 1 : 0;
  }
  const double mean = sum / kTrials;
  verdict.z = mean / std::sqrt((squares / kTrials - mean * mean) / (kTrials - 1));
  return verdict;
}

TEST(DenoisedHalves, StateTheErrorWithoutBias) {
  std::vector<uint32_t> uneven(kPixels);
  for (size_t i = 0; i < kPixels; ++i) uneven[i] = 16 + static_cast<uint32_t>(i % 7);
  for (const auto& rays : {std::vector<uint32_t>(kPixels, 32), uneven}) {
    const Verdict verdict = judge(rays);
    EXPECT_LT(std::abs(verdict.z), 4);
    EXPECT_GE(verdict.covered, 54);  // of 60: 97 % are expected, and fewer have a probability of 0.002
  }
  // The control: halves that share samples do not see what they have in common.
  EXPECT_LT(judge(std::vector<uint32_t>(kPixels, 32), 0.3f).z, -8);
}

TEST(DenoisedHalves, TakeWhatTheFilterLosesFromTheNoisyPicture) {
  const std::vector<uint32_t> few(kPixels, 4), many(kPixels, 4096);
  EXPECT_LT(trial(1, few).stated.noisy_share, 0.3);
  // A filter that blurs everything is worth nothing where there is hardly any noise.
  const Trial converged = trial(1, many, 5);
  EXPECT_GT(converged.stated.noisy_share, 0.95);
  const Picture noisy = samples(1, 0, many, 0.5f);
  EXPECT_LT(converged.real, error_of(noisy, truth()));
}

TEST(DenoisedHalves, OfOneColorHaveNoError) {
  const Picture flat(3 * kPixels, 0.5f);
  const std::vector<uint32_t> rays(kPixels, 2);
  Picture picture(flat.size());
  const DenoisedError error = combine({{flat, flat}, {flat, flat}, rays}, picture);
  EXPECT_EQ(error.bound(), 0);
  EXPECT_EQ(picture, flat);
  const Picture black(3 * kPixels, 0.0f);
  EXPECT_EQ(combine({{black, black}, {black, black}, rays}, picture).bound(), 0);
}

}  // namespace
}  // namespace velour::halves_test

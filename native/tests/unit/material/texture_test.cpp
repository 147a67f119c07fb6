#include "material/texture.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/error.h"
#include "image/picture.h"
#include "math/sphere/random.h"

namespace velour::texture_test {
namespace {

const Mat2 kPoint(0.0f);

Texture<float> noise(int width, int height, const TextureOptions& options = {}) {
  std::vector<float> texels(static_cast<size_t>(width) * static_cast<size_t>(height));
  RandomStream random(1, 2, 3);
  for (float& t : texels) t = random.next();
  return {width, height, texels, options};
}

Texture<float> checker(int side, int square) {
  std::vector<float> texels;
  for (int i = 0; i < side * side; ++i) {
    texels.push_back(static_cast<float>((i % side / square + i / side / square) % 2));
  }
  return {side, side, texels, {}};
}

/// Mean over the footprint of the exact picture, in which each texel has one value all over.
double exact_mean(const Texture<float>& closest, const Vec2& uv, const Mat2& footprint) {
  constexpr int kSteps = 64;
  double sum = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const Vec2 place((static_cast<float>(i % kSteps) + 0.5f) / kSteps,
                     (static_cast<float>(i / kSteps) + 0.5f) / kSteps);
    sum += static_cast<double>(closest.look_up(uv + footprint * (place - 0.5f), kPoint));
  }
  return sum / (kSteps * kSteps);
}

TEST(Texture, IsItsTexelsAtTheirCentersAndLinearBetween) {
  const Texture<Rgb> texture(2, 2, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {.wrap = TextureWrap::extend});
  EXPECT_EQ(texture.look_up({0.25f, 0.25f}, kPoint), Rgb(1, 0, 0));
  EXPECT_EQ(texture.look_up({0.75f, 0.25f}, kPoint), Rgb(0, 1, 0));
  EXPECT_EQ(texture.look_up({0.25f, 0.75f}, kPoint), Rgb(0, 0, 1));
  EXPECT_EQ(texture.look_up({0.5f, 0.25f}, kPoint), Rgb(0.5f, 0.5f, 0));
  EXPECT_EQ(texture.look_up({0.5f, 0.5f}, kPoint), Rgb(0.5f));
}

TEST(Texture, ClosestIsTheTexelUnderThePoint) {
  const Texture<float> texture(2, 1, {3, 5}, {.filter = TextureFilter::closest});
  EXPECT_EQ(texture.look_up({0.49f, 0.9f}, kPoint), 3);
  EXPECT_EQ(texture.look_up({0.51f, 0.9f}, kPoint), 5);
  EXPECT_EQ(texture.look_up({-0.01f, 0}, kPoint), 5);
}

float at(TextureWrap wrap, float u) {
  return Texture<float>(4, 1, {1, 2, 3, 4}, {.wrap = wrap}).look_up({u, 0.5f}, kPoint);
}

TEST(Texture, GoesOnBeyondItsBorderAsAsked) {
  EXPECT_NEAR(at(TextureWrap::repeat, 1.0f), 2.5f, 1e-6f);
  EXPECT_NEAR(at(TextureWrap::repeat, -7.0f), 2.5f, 1e-6f);
  EXPECT_NEAR(at(TextureWrap::repeat, 3.375f), 2, 1e-5f);
  EXPECT_EQ(at(TextureWrap::extend, 1.0f), 4);
  EXPECT_EQ(at(TextureWrap::extend, 100.0f), 4);
  EXPECT_EQ(at(TextureWrap::extend, -1e30f), 1);
  EXPECT_EQ(at(TextureWrap::mirror, 1.0f), 4);
  EXPECT_NEAR(at(TextureWrap::mirror, 1.125f), 4, 1e-5f);
  EXPECT_NEAR(at(TextureWrap::mirror, 1.375f), 3, 1e-5f);
  EXPECT_NEAR(at(TextureWrap::mirror, -0.375f), 2, 1e-5f);
  EXPECT_NEAR(at(TextureWrap::mirror, 2.375f), 2, 1e-5f);
  EXPECT_EQ(at(TextureWrap::clip, 1.25f), 0);
  EXPECT_EQ(at(TextureWrap::clip, -1e30f), 0);
}

StoredTexels edge(const glm::vec4& left, const glm::vec4& right, bool srgb, bool premultiplied) {
  StoredTexels stored;
  stored.texels = {left, right};
  stored.srgb = srgb;
  stored.premultiplied = premultiplied;
  return stored;
}

/// Closed form: the sRGB curve of the mean. Also if the values are not those of bytes.
TEST(Texture, SrgbTexelsAreInterpolatedBeforeTheyAreDecoded) {
  for (const float value : {1.0f, 0.3003f}) {
    const Texture<Rgb> texture(2, 1, edge({0, 0, 1, 1}, {value, 0, 0, 1}, true, false), {.wrap = TextureWrap::extend});
    EXPECT_NEAR(texture.look_up({0.5f, 0.5f}, kPoint).r, linear_from_srgb(0.5f * value), 1e-6f);
    EXPECT_NEAR(texture.look_up({0.5f, 0.5f}, kPoint).b, linear_from_srgb(0.5f), 1e-6f);
    EXPECT_NEAR(texture.look_up({0.75f, 0.5f}, kPoint).r, linear_from_srgb(value), 1e-6f);
    EXPECT_NEAR(texture.look_up({0.5f, 0.5f}, Mat2(1000)).r, 0.5f * linear_from_srgb(value), 1e-6f) << "a mean";
  }
}

/// An opaque color keeps it up to where nothing is left of it; without alpha it darkens.
TEST(Texture, PremultipliedColorsAreInterpolatedBeforeTheyAreDivided) {
  for (const bool premultiplied : {true, false}) {
    const Texture<Rgb> texture(2, 1, edge({0.8f, 0.4f, 0, 1}, glm::vec4(0), false, premultiplied),
                               {.wrap = TextureWrap::extend});
    EXPECT_NEAR(texture.look_up({0.5f, 0.5f}, kPoint).r, premultiplied ? 0.8f : 0.4f, 1e-6f);
    EXPECT_EQ(texture.look_up({0.75f, 0.5f}, kPoint), Rgb(0));
  }
}

/// Mean color times mean alpha is the mean of color times alpha.
TEST(Texture, PremultipliedColorsAreAveragedByTheirAlpha) {
  const Texture<Rgb> texture(2, 1, edge({0.8f, 0, 0, 1}, {0, 0.1f, 0, 0.25f}, true, true), {});
  const Rgb mean = texture.look_up({0.3f, 0.5f}, Mat2(1000));
  EXPECT_NEAR(mean.r, linear_from_srgb(0.8f) / 1.25f, 1e-5f);
  EXPECT_NEAR(mean.g, linear_from_srgb(0.4f) * 0.25f / 1.25f, 1e-5f);
  const Texture<Rgb> nothing(2, 1, edge({0.8f, 0, 0, 0}, {0.4f, 0, 0, 0}, false, true), {});
  EXPECT_NEAR(nothing.look_up({0.3f, 0.5f}, Mat2(1000)).r, 0.6f, 1e-5f) << "seen without its alpha";
}

TEST(Texture, AStoredColorBecomesANumberOnceItIsDecoded) {
  StoredTexels stored = edge({1, 0, 0, 1}, {0, 1, 0, 1}, true, false);
  stored.colors = glm::transpose(Mat3(Rgb(0.2f, 0.7f, 0.1f), Rgb(0), Rgb(0)));
  const Texture<float> texture(2, 1, stored, {.wrap = TextureWrap::extend});
  EXPECT_NEAR(texture.look_up({0.25f, 0.5f}, kPoint), 0.2f, 1e-6f);
  EXPECT_NEAR(texture.look_up({0.5f, 0.5f}, kPoint), 0.9f * linear_from_srgb(0.5f), 1e-6f);
}

/// Also of sides that halve with a rest.
TEST(Texture, EveryLevelHasThePicturesMean) {
  for (const auto& [width, height] : {std::pair{16, 16}, {7, 5}, {1, 13}, {100, 3}, {31, 64}}) {
    const Texture<float> texture = noise(width, height);
    double mean = 0;
    for (int i = 0; i < width * height; ++i) {
      const Vec2 texel((static_cast<float>(i % width) + 0.5f) / static_cast<float>(width),
                       (static_cast<float>(i / width) + 0.5f) / static_cast<float>(height));
      mean += static_cast<double>(texture.look_up(texel, kPoint)) / (width * height);
    }
    EXPECT_NEAR(texture.look_up({0.3f, 0.9f}, Mat2(1)), mean, 0.01) << width << 'x' << height;  // few taps
    EXPECT_NEAR(texture.look_up({0.3f, 0.9f}, Mat2(1000)), mean, 1e-5) << width << 'x' << height;
  }
}

TEST(Texture, AMinifiedCheckerHasItsMean) {
  const Texture<float> texture = checker(256, 4);
  for (const float texels : {16.0f, 23.0f, 100.0f, 1e6f}) {
    for (int i = 0; i < 20; ++i) {
      const Vec2 uv(0.05f * static_cast<float>(i), 0.37f * static_cast<float>(i));
      EXPECT_NEAR(texture.look_up(uv, Mat2(texels / 256)), 0.5f, 0.01f) << texels;
    }
  }
}

/// Root of the mean square difference from the exact means, over footprints `stretch` times as long as wide.
double error_of(const Texture<float>& texture, const Texture<float>& closest, float stretch, bool as_square) {
  RandomStream random(5, 5, 5);
  double sum = 0;
  constexpr int kCases = 300;
  for (int i = 0; i < kCases; ++i) {
    const float angle = 2 * kPi * random.next(), c = std::cos(angle), s = std::sin(angle);
    const float width = 2.0f / static_cast<float>(texture.width());
    const Vec2 uv = random.next2();
    const Mat2 footprint(stretch * width * c, stretch * width * s, -width * s, width * c);
    const double exact = exact_mean(closest, uv, footprint);
    const double found = static_cast<double>(texture.look_up(uv, as_square ? Mat2(stretch * width) : footprint));
    sum += (found - exact) * (found - exact);
  }
  return std::sqrt(sum / kCases);
}

TEST(Texture, AveragesAlongALongFootprint) {
  const Texture<float> texture = noise(128, 128), closest = noise(128, 128, {.filter = TextureFilter::closest});
  for (const float stretch : {4.0f, 8.0f}) {
    const double along = error_of(texture, closest, stretch, false), square = error_of(texture, closest, stretch, true);
    RecordProperty("stretch_" + std::to_string(static_cast<int>(stretch)),
                   std::to_string(along) + " / " + std::to_string(square));
    EXPECT_LT(along, 0.75 * square) << stretch;
    EXPECT_LT(along, 0.035) << stretch;  // a texel's deviation is 0.289
  }
}

TEST(Texture, AConstantStaysOne) {
  RandomStream random(4, 4, 4);
  for (const TextureWrap wrap : {TextureWrap::repeat, TextureWrap::extend, TextureWrap::mirror}) {
    const Texture<float> texture(9, 6, std::vector<float>(54, 0.7f), {.wrap = wrap});
    for (int i = 0; i < 2000; ++i) {
      const float size = std::exp(20 * random.next() - 15);
      const auto any = [&] { return 2 * size * (random.next() - 0.5f); };
      const Vec2 uv(any(), any());
      EXPECT_NEAR(texture.look_up(uv, Mat2(any(), any(), any(), any())), 0.7f, 1e-5f);
    }
  }
}

TEST(Texture, WhatIsNotFiniteCountsAsNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Texture<float> texture(2, 1, {nan, 4}, {.wrap = TextureWrap::extend});
  EXPECT_EQ(texture.look_up({0.1f, 0.5f}, kPoint), 0);
  EXPECT_EQ(texture.look_up({0.9f, 0.5f}, kPoint), 4);
  EXPECT_EQ(texture.look_up({nan, 0.5f}, kPoint), 0);
}

TEST(Texture, NeedsAsManyTexelsAsItsSizeSays) {
  EXPECT_THROW(Texture<float>(2, 2, {1, 2, 3}, {}), Error);
  EXPECT_THROW(Texture<float>(0, 2, std::vector<float>(), {}), Error);
  EXPECT_THROW(Texture<float>(2, 2, edge({}, {}, true, true), {}), Error);
}

}  // namespace
}  // namespace velour::texture_test

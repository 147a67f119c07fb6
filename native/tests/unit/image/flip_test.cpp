#include "image/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace velour::flip_test {
namespace {

constexpr int kFlipWidth = 48, kFlipHeight = 32;

using Change = std::function<Rgb(const Rgb&, int x, int y)>;

/// A colorful picture, and what becomes of it.
LinearPicture picture(const Change& change = {}) {
  LinearPicture out{kFlipWidth, kFlipHeight, {}};
  for (int y = 0; y < kFlipHeight; ++y) {
    for (int x = 0; x < kFlipWidth; ++x) {
      const float u = (static_cast<float>(x) + 0.5f) / kFlipWidth, v = (static_cast<float>(y) + 0.5f) / kFlipHeight;
      const Rgb color(u, v, 1 - u * v);
      out.pixels.push_back(change ? change(color, x, y) : color);
    }
  }
  return out;
}

Rgb gamma(const Rgb& c, int, int) { return glm::pow(c, Rgb(1.3f)); }
Rgb patch(const Rgb& c, int x, int y) { return y >= 8 && y < 14 && x >= 20 && x < 29 ? Rgb(0.9f, 0.1f, 0.1f) : c; }
Rgb stripes(const Rgb& c, int x, int) { return c * (x / 2 % 2 ? 1.0f : 0.75f); }
Rgb blue(const Rgb& c, int, int) { return {c.r, c.g, std::min(c.b + 0.1f, 1.0f)}; }

/// Results of the authors' program (flip-evaluator 1.7): the mean, and the pixels (0, 0), (24, 11) and (40, 20).
struct Known {
  const char* name;
  Change change;
  double pixels_per_degree, mean, pixels[3];
};
const Known kKnown[] = {
    {"gamma", gamma, kFlipPixelsPerDegree, 0.286942, {0.203776, 0.313892, 0.265044}},
    {"gamma from nearby", gamma, 30, 0.274387, {0.162324, 0.305204, 0.251401}},
    {"patch", patch, kFlipPixelsPerDegree, 0.056944, {0, 0.825984, 0}},
    {"patch from nearby", patch, 30, 0.043424, {0, 0.959359, 0}},
    {"stripes", stripes, kFlipPixelsPerDegree, 0.264965, {0.369767, 0.285324, 0.264193}},
    {"stripes from nearby", stripes, 30, 0.303163, {0.376382, 0.396503, 0.397776}},
    {"blue", blue, kFlipPixelsPerDegree, 0.180989, {0.007555, 0.190776, 0.240503}},
};

double mean(const std::vector<float>& values) {
  double sum = 0;
  for (const float v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

TEST(Flip, AgreesWithItsAuthors) {
  constexpr double kClose = 5e-5;
  for (const Known& known : kKnown) {
    const std::vector<float> found = flip_map(picture(), picture(known.change), known.pixels_per_degree);
    EXPECT_NEAR(mean(found), known.mean, kClose) << known.name;
    constexpr size_t kAt[3] = {0, 11 * kFlipWidth + 24, 20 * kFlipWidth + 40};
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[kAt[i]], known.pixels[i], kClose) << known.name << " " << i;
  }
}

TEST(Flip, EqualPicturesDoNotDiffer) {
  for (const float v : flip_map(picture(), picture())) EXPECT_EQ(v, 0);
}

TEST(Flip, GreenAndBlueDifferMost) {
  const auto plain = [](const Rgb& color) { return picture([=](const Rgb&, int, int) { return color; }); };
  EXPECT_NEAR(mean(flip_map(plain({0, 1, 0}), plain({0, 0, 1}))), 1, 1e-6);
  EXPECT_LT(mean(flip_map(plain({0, 0, 0}), plain({1, 1, 1}))), 0.98);
}

}  // namespace
}  // namespace velour::flip_test

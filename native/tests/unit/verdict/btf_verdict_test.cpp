#include "verdict/btf_verdict.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "support/memory_btf.h"

namespace velour::btf_verdict_test {
namespace {

/// A checkered cloth of two yarns, with some gloss.
Rgb cloth(const DirectionPair& pair, uint32_t x, uint32_t y) {
  const Rgb yarn = (x / 4 + y / 4) % 2 == 0 ? Rgb(0.2f, 0.03f, 0.02f) : Rgb(0.03f, 0.05f, 0.15f);
  const float cosine = glm::normalize(pair.wl + pair.wv).z;
  return yarn + Rgb(0.05f * std::pow(std::max(cosine, 0.0f), 20.0f));
}

test::MemoryBtf btf_of(const test::BtfFormula& f) {
  return {PairLayout(bonn_directions(), bonn_directions()), {8, 8}, f};
}

std::vector<float> image_of(const DirectionPair& pair, const test::BtfFormula& f) {
  std::vector<float> rgb;
  for (uint32_t y = 0; y < 8; ++y) {
    for (uint32_t x = 0; x < 8; ++x) {
      const Rgb c = f(pair, x, y);
      rgb.insert(rgb.end(), {c.r, c.g, c.b});
    }
  }
  return rgb;
}

Verdict judged(const test::BtfFormula& measured, const test::BtfFormula& shown) {
  const auto images = [&](const DirectionPair& pair, std::vector<float>& rgb) { rgb = image_of(pair, shown); };
  return judge_btf(btf_of(measured), images, Progress()).value();
}

test::BtfFormula changed(const std::function<Rgb(const Rgb&, const DirectionPair&)>& change) {
  return [=](const DirectionPair& pair, uint32_t x, uint32_t y) { return change(cloth(pair, x, y), pair); };
}

TEST(BtfVerdict, AnExactCopyIsGood) {
  const Verdict verdict = judged(cloth, cloth);
  EXPECT_EQ(verdict.quality, LookQuality::good);
  EXPECT_LT(verdict.flip_mean, 2e-3);  // the measurement has half floats
}

TEST(BtfVerdict, AFlatColorIsPoor) {
  const Verdict verdict = judged(cloth, [](const DirectionPair& pair, uint32_t, uint32_t) {
    return 0.5f * (cloth(pair, 0, 0) + cloth(pair, 4, 0));
  });
  EXPECT_EQ(verdict.quality, LookQuality::poor);
}

TEST(BtfVerdict, ReasonsAreFound) {
  const Verdict brighter = judged(cloth, changed([](const Rgb& c, const DirectionPair&) { return 1.4f * c; }));
  EXPECT_EQ(brighter.reason, LookReason::brightness);
  EXPECT_NEAR(brighter.value, 1.4, 0.01);
  const Verdict gray = judged(cloth, changed([](const Rgb& c, const DirectionPair&) { return Rgb(luminance(c)); }));
  EXPECT_EQ(gray.reason, LookReason::color);
  const Verdict grazing = judged(cloth, changed([](const Rgb& c, const DirectionPair& pair) {
                                   return pair.wv.z < 0.4f ? Rgb(3 * c.g, c.r / 3, c.g) : c;
                                 }));
  EXPECT_NE(grazing.quality, LookQuality::good);
}

TEST(BtfVerdict, PicturesAreOfFiveViewsAndThreeLights) {
  const auto images = [](const DirectionPair& pair, std::vector<float>& rgb) { rgb = image_of(pair, cloth); };
  const auto pictures = tile_pictures(btf_of(cloth), images, Progress());
  ASSERT_EQ(pictures.size(), 15u);
  for (const PicturePair& each : pictures) {
    EXPECT_EQ(each.measured.width, 16);
    double mean = 0;
    for (const Rgb& c : each.measured.pixels) mean += static_cast<double>(luminance(c)) / 256;
    EXPECT_NEAR(mean, static_cast<double>(kPhotographicGray), 1e-5);
  }
  EXPECT_NEAR(pictures.back().view_angle[0], 75 * kPi / 180, 1e-4f);
}

TEST(BtfVerdict, NothingAboveThePlaneHasNone) {
  const test::MemoryBtf btf(PairLayout(below(ring_directions(30, 4)), ring_directions(30, 4)), {8, 8}, cloth);
  const auto images = [](const DirectionPair& pair, std::vector<float>& rgb) { rgb = image_of(pair, cloth); };
  EXPECT_FALSE(judge_btf(btf, images, Progress()));
}

}  // namespace
}  // namespace velour::btf_verdict_test

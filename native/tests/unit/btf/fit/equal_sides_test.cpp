#include "btf/fit/fitted_sides.h"

#include <gtest/gtest.h>

#include "btf/fit/btf_fit.h"
#include "btf/fit/srbf/srbf_fit.h"
#include "btf/model/srbf_evaluator.h"
#include "math/sphere/random.h"
#include "support/striped_btf.h"

namespace velour::equal_sides_test {
namespace {

const TexelGrid kSidesGrid{8, 6};
constexpr float kNoise = 0.02f;  // of a value, one standard deviation

/// The same from both sides; light goes through.
Rgb symmetric(const DirectionPair& d, uint32_t x, uint32_t y) {
  const float through = d.wl.z * d.wv.z < 0 ? 0.3f : 1.0f;
  return through * test::striped({{d.wl.x, d.wl.y, std::abs(d.wl.z)}, {d.wv.x, d.wv.y, std::abs(d.wv.z)}}, x, y);
}

/// With noise of its own at every texel and pair, and its standard errors; from below `shift` of itself more.
class NoisyBtf final : public BtfMeasurement {
 public:
  explicit NoisyBtf(float shift) : clean_(test::ringed_layout(true), kSidesGrid, symmetric) {
    layout_ = clean_.layout();
    grid_ = kSidesGrid;
    for (uint64_t pair = 0; pair < layout_->pairs(); ++pair) add(pair, shift);
  }
  void read_pairs(uint64_t first, uint64_t count, std::span<HalfBits> values) const override {
    const size_t image = kSidesGrid.texels() * 3;
    floats_to_halves({values_.data() + first * image, count * image}, values);
  }
  bool has_errors() const override { return true; }
  bool read_errors(uint64_t first, uint64_t count, std::span<HalfBits> errors) const override {
    floats_to_halves({errors_.data() + first * kSidesGrid.texels(), count * kSidesGrid.texels()}, errors);
    return true;
  }

 private:
  void add(uint64_t pair, float shift) {
    const DirectionPair directions = layout_->directions(pair);
    const float mean = directions.wv.z < 0 ? 1 + shift : 1;
    for (uint32_t t = 0; t < kSidesGrid.texels(); ++t) {
      RandomStream random(7, pair, t);
      const float deviation = (random.next() - 0.5f) * std::sqrt(12.0f) * kNoise;
      const Rgb f = symmetric(directions, t % kSidesGrid.width, t / kSidesGrid.width);
      for (const float c : {f.r, f.g, f.b}) values_.push_back(c * (mean + deviation));
      errors_.push_back(luminance(f) * kNoise);
    }
  }
  test::MemoryBtf clean_;
  std::vector<float> values_, errors_;
};

bool equal(const BtfMeasurement& btf, size_t a, size_t b) {
  const auto sides = sides_of(btf.layout());
  return sides_are_equal(btf, sides.at(a), sides.at(b), Progress());
}

TEST(EqualSides, AreFoundWithoutNoise) {
  const test::MemoryBtf same(test::ringed_layout(true), kSidesGrid, symmetric);
  EXPECT_TRUE(equal(same, 0, 2));   // reflection from above and from below
  EXPECT_TRUE(equal(same, 1, 3));   // through, down and up
  EXPECT_FALSE(equal(same, 0, 1));  // what is reflected and what goes through
  EXPECT_FALSE(equal(test::striped_btf(kSidesGrid, true), 0, 2));
}

TEST(EqualSides, DifferWithinTheirNoise) {
  EXPECT_TRUE(equal(NoisyBtf(0), 0, 2));
  // A shift of half a standard deviation does not show in a texel, and does in the means.
  EXPECT_FALSE(equal(NoisyBtf(0.5f * kNoise), 0, 2));
  EXPECT_FALSE(equal(NoisyBtf(10 * kNoise), 0, 2));
}

TEST(EqualSides, NeedTheSameDirections) {
  std::vector<PolarAngles> views = ring_directions(30, 5);
  for (const PolarAngles& d : below(ring_directions(40, 5))) views.push_back(d);
  const test::MemoryBtf btf({views, views}, kSidesGrid, [](auto&&...) { return Rgb(1.0f); });
  EXPECT_FALSE(equal(btf, 0, 2));
}

TEST(EqualSides, TakeNoBytes) {
  const test::MemoryBtf same(test::ringed_layout(true), kSidesGrid, symmetric);
  Progress progress;
  FitCheckpoint none;
  SrbfFitter fitter(same, {.bytes = 4000}, none, progress);
  const auto btf = std::make_shared<const SrbfBtf>(std::get<SrbfBtf>(fitter.fit(fitter.largest())));
  ASSERT_EQ(btf->sides.size(), 2u);
  ASSERT_EQ(btf->shared.size(), 2u);
  EXPECT_LE(btf->parameter_bytes(), 4000u);
  const SrbfEvaluator evaluator(btf);
  std::vector<float> above, under;
  const Vec3 wl = unit_direction(same.layout().lights()[2]), wv = unit_direction(same.layout().views()[3]);
  srbf_image(evaluator, {wl, wv}, above);
  srbf_image(evaluator, {{wl.x, wl.y, -wl.z}, {wv.x, wv.y, -wv.z}}, under);
  EXPECT_EQ(above, under);
  EXPECT_GT(above[0], 0.0f);
}

/// A model needs a side, even if its BTF only transmits light and is black.
TEST(FittedSides, AreNeverNone) {
  std::vector<PolarAngles> lights = below(ring_directions(50, 6));
  const test::MemoryBtf btf({ring_directions(30, 5), lights}, kSidesGrid, [](auto&&...) { return Rgb(0.0f); });
  for (const CompressMethod method : {CompressMethod::srbf, CompressMethod::kcta}) {
    CompressOptions options;
    options.method = method;
    options.memory = uint64_t{1} << 30;
    Progress progress;
    const Model model = compress_btf(btf, options, progress);
    EXPECT_EQ(model.btf->relative_l2, 0.0);
    const auto* srbf = std::get_if<SrbfBtf>(&model.body);
    EXPECT_EQ(srbf ? srbf->sides.size() : std::get<TensorBtf>(model.body).sides.size(), 1u);
  }
}

}  // namespace
}  // namespace velour::equal_sides_test

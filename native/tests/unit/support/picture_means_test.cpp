#include "support/picture_means.h"

#include "image/picture.h"
#include "math/sphere/random.h"
#include "support/artifacts_fixture.h"

namespace velour::test {
namespace {

/// Noisy pictures of 8 x 4 pixels that brighten to the right; `brighter` in the block of the lower right corner.
PictureMeans noisy(uint64_t first_seed, double brighter = 1) {
  PictureMeans means(8, 4, 2);
  for (uint64_t seed = first_seed; seed < first_seed + 20; ++seed) {
    RandomStream random(seed, 0, 0);
    std::vector<float> rgba;
    for (size_t i = 0; i < 32; ++i) {
      const size_t x = i % 8, y = i / 8;
      const float value = (1 + static_cast<float>(x)) * (0.5f + random.next());
      rgba.insert(rgba.end(), 3, x >= 6 && y < 2 ? value * static_cast<float>(brighter) : value);
      rgba.push_back(1);
    }
    means.add(rgba);
  }
  return means;
}

class PictureMeansTest : public ArtifactsFixture {};

TEST_F(PictureMeansTest, EqualPicturesAgreeAndLeaveNothing) {
  ZTests tests;
  compare("same", noisy(0), noisy(100), tests);
  EXPECT_TRUE(tests.agree());
  EXPECT_TRUE(files().empty());
  EXPECT_NEAR(noisy(0).whole().mean, 4.5, 0.2);
  EXPECT_LT(tests.smallest_bias("same whole"), 0.15);
}

TEST_F(PictureMeansTest, ABlockThatDiffersIsNamedAndPicturesAreLeft) {
  ZTests tests;
  const PictureMeans found = noisy(0, 2), expected = noisy(100);
  compare("one block", found, expected, tests);
  const auto verdict = tests.agree();
  ASSERT_FALSE(verdict);
  const std::string message = verdict.message();
  EXPECT_NE(message.find("one block block 3 0"), std::string::npos) << message;
  EXPECT_EQ(message.find("one block block 2 1"), std::string::npos) << message;
  EXPECT_EQ(files().size(), 4u);  // three pictures and the list
  for (const auto& path : files()) {
    EXPECT_NE(message.find(path.string()), std::string::npos) << path;
    if (path.extension() != ".exr") continue;
    const Picture picture = read_picture(path.string());
    ASSERT_EQ(picture.width, 8);
    ASSERT_EQ(picture.height, 4);
    const bool z_map = path.string().find(".z.exr") != std::string::npos;
    const float inside = picture.pixel(7, 0)[1], outside = picture.pixel(2, 3)[1];
    if (z_map) {
      EXPECT_GT(inside, 5);
      EXPECT_LT(std::abs(outside), 5);
    }
  }
}

}  // namespace
}  // namespace velour::test

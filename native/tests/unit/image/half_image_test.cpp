#include "image/texels.h"

#include <gtest/gtest.h>

#include <numeric>

namespace velour::half_image_test {
namespace {

TEST(HalfImage, KeepsTheMeanOfAnySize) {
  for (const auto& [width, height] : {std::pair(8u, 4u), std::pair(7u, 5u), std::pair(1u, 9u), std::pair(3u, 1u)}) {
    std::vector<float> image(size_t{width} * height * 2);
    for (size_t i = 0; i < image.size(); ++i) image[i] = static_cast<float>(i * i % 17);
    const auto mean = [](const std::vector<float>& v, size_t channel) {
      double sum = 0;
      for (size_t i = channel; i < v.size(); i += 2) sum += static_cast<double>(v[i]);
      return sum / (static_cast<double>(v.size()) / 2);
    };
    const std::vector<float> half = half_image(image, width, height, 2);
    EXPECT_NEAR(mean(half, 0), mean(image, 0), 1e-5);
    EXPECT_NEAR(mean(half, 1), mean(image, 1), 1e-5);
  }
}

TEST(HalfImage, IsTheMeanOfFourWhereSizesAreEven) {
  const std::vector<float> half = half_image(std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8}, 4, 2, 1);
  EXPECT_EQ(half, (std::vector<float>{3.5f, 5.5f}));
}

}  // namespace
}  // namespace velour::half_image_test

#include "fit/sample_spacing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fit/picture_weights.h"
#include "fit/view_grid.h"

namespace velour {
namespace {

/// A view's own lights, with an f cos that has a highlight about `center` (of half vectors) over `base`.
std::vector<SliceSample> lights_of(const Vec3& wv, float peak, float base) {
  const LightGrid grid = light_grid(wv, 64, 32);
  std::vector<SliceSample> out;
  for (size_t i = 0; i < grid.wl.size(); ++i) {
    const Vec3 h = glm::normalize(grid.wl[i] + wv);
    out.push_back({grid.wl[i], grid.weight[i], Rgb(base + peak * std::exp(500 * (h.z - 1)))});
  }
  return out;
}

TEST(SampleSpacing, HighlightsMayBeSharpAndWhatIsFarFromThemMayNot) {
  const Vec3d wv = Vec3d(direction(radians_from(75.0f), 0.0f));
  const SampleSpacing spacing(lights_of(Vec3(wv), 1, 1), wv);
  const double at_mirror = spacing.most_log_bandwidth(LobeSpace::half, {0, 0, 1});
  const double at_retro = spacing.most_log_bandwidth(LobeSpace::light, wv);
  EXPECT_GT(at_mirror, std::log(1e5));
  EXPECT_LT(at_retro, std::log(1e3));
}

// Near the mirror direction samples crowd from one degree to the next, and the spacing is that of the finest.
TEST(SampleSpacing, FarFromTheMirrorDirectionALobeOfTheLeastWidthMeetsSamples) {
  const Vec3d wv = Vec3d(direction(radians_from(40.0f), 0.0f));
  const auto samples = lights_of(Vec3(wv), 1, 1);
  const SampleSpacing spacing(samples, wv);
  for (const float theta : {10.0f, 30.0f, 60.0f, 80.0f}) {
    for (const float phi : {0.3f, 0.9f, 1.3f, 1.7f}) {
      const Vec3d center = Vec3d(direction(radians_from(theta), phi));
      const double bandwidth = std::exp(spacing.most_log_bandwidth(LobeSpace::light, center));
      const auto seen = [&](double sharpness) {
        double sum = 0;
        for (const SliceSample& s : samples) {
          sum += static_cast<double>(s.weight) * std::exp(sharpness * (glm::dot(Vec3d(s.wl), center) - 1));
        }
        return sum * sharpness / (2 * kPiD);  // 1 when the samples tell the lobe's integral
      };
      EXPECT_GT(seen(bandwidth), 0.05) << theta << " " << phi;
    }
  }
}

TEST(SampleSpacing, NothingIsAskedWhereThereAreNoSamples) {
  const Vec3d wv(0, 0, 1);
  EXPECT_GT(SampleSpacing({}, wv).most_log_bandwidth(LobeSpace::light, wv), 50);
}

TEST(PictureWeights, TakeEveryBrightnessByItsRatio) {
  const auto samples = lights_of({0, 0, 1}, 1000, 1);
  const std::vector<float> weight = picture_weights(samples);
  ASSERT_EQ(weight.size(), samples.size());
  double sum = 0, dim = 0, solid_angle = 0, square = 0, dim_square = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    const double w = static_cast<double>(samples[i].weight), y = static_cast<double>(luminance(samples[i].value));
    const double part = w * static_cast<double>(weight[i]) * y * y;
    const bool is_dim = y < 10;
    sum += part, square += w * y * y;
    if (is_dim) dim += part, dim_square += w * y * y;
    solid_angle += w;
  }
  EXPECT_NEAR(sum, 1, 1e-4);
  EXPECT_GT(dim, 0.5);                    // most directions are dim
  EXPECT_LT(dim_square, 0.001 * square);  // and count for nothing in the squared error
}

TEST(PictureWeights, BlackHasNone) { EXPECT_TRUE(picture_weights(lights_of({0, 0, 1}, 0, 0)).empty()); }

}  // namespace
}  // namespace velour

#include "scene/sky_irradiance.h"

#include <algorithm>

#include "sphere/sobol.h"

namespace velour {
namespace {

constexpr uint32_t kIrradianceDraws = 1024;
constexpr float kLeastOfMean = 0.05f;

std::array<float, 9> harmonics(const Vec3& w) {
  return {0.282095f,
          0.488603f * w.y,
          0.488603f * w.z,
          0.488603f * w.x,
          1.092548f * w.x * w.y,
          1.092548f * w.y * w.z,
          0.315392f * (3.0f * w.z * w.z - 1.0f),
          1.092548f * w.x * w.z,
          0.546274f * (w.x * w.x - w.y * w.y)};
}

/// Coefficients of the clamped cosine for the nine harmonics, which depend on their degree only.
constexpr float kCosine[9] = {kPi, 2 * kPi / 3, 2 * kPi / 3, 2 * kPi / 3, kPi / 4, kPi / 4, kPi / 4, kPi / 4, kPi / 4};

}  // namespace

SkyIrradiance::SkyIrradiance(const Environment& sky) {
  if (sky.black()) return;
  least_ = kLeastOfMean * kPi * sky.mean_luminance();
  std::array<double, 9> sum{};
  for (uint32_t first = 0; first < kIrradianceDraws; first += DirectionBatch::kCapacity) {
    Vec2 u[DirectionBatch::kCapacity];
    sobol_points(0, first, u);
    DirectionBatch world;
    RgbBatch radiance;
    ScalarBatch pdf;
    sky.sample(u, world);
    world.pad();
    sky.look_up(world, radiance, pdf);
    for (int i = 0; i < world.count; ++i) {
      if (!(pdf.v[i] > 0.0f)) continue;
      const float light = luminance(radiance.get(i)) / pdf.v[i];
      const std::array<float, 9> y = harmonics(world.get(i));
      for (size_t k = 0; k < 9; ++k) sum[k] += static_cast<double>(light * y[k]);
    }
  }
  for (size_t k = 0; k < 9; ++k) weight_[k] = kCosine[k] * static_cast<float>(sum[k] / kIrradianceDraws);
}

float SkyIrradiance::on(const Vec3& normal) const {
  const std::array<float, 9> y = harmonics(normal);
  float sum = 0;
  for (size_t k = 0; k < 9; ++k) sum += weight_[k] * y[k];
  return std::max(sum, least_);
}

}  // namespace velour

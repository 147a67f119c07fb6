#include "light/environment.h"

#include <algorithm>
#include <cmath>
#include "base/error.h"
#include "light/equirectangular.h"
#include "math/sphere/random.h"
#include "math/sphere/warp.h"

namespace velour {

namespace {

constexpr float kUniformPdf = 0.25f / kPi;

[[noreturn]] void fail(const char* sentence) { throw Error(Status::bad_data, sentence); }

void check(const EquirectangularPixels& p) {
  if (p.width <= 0 || p.height <= 0) fail("The environment image has no pixels.");
  if (p.width > 65535 || p.height > 65535)
    fail("The environment image is more than 65535 pixels wide or high. Scale it down.");
  if (p.channels < 1 || p.channels > 4) fail("The environment image must have 1 to 4 channels.");
  const size_t count = static_cast<size_t>(p.width) * static_cast<size_t>(p.height) * static_cast<size_t>(p.channels);
  if (p.values.size() != count) fail("The number of values of the environment image does not match its size.");
}

EnvironmentPlacement checked(float strength, const Mat3& world_to_image) {
  if (!std::isfinite(strength)) fail("The strength of the environment is not finite.");
  const Mat3 product = glm::transpose(world_to_image) * world_to_image - Mat3(1.0f);
  for (int i = 0; i < 9; ++i) {
    if (!(std::abs(product[i / 3][i % 3]) < 1e-3f)) fail("The rotation of the environment is not a rotation matrix.");
  }
  return {std::max(strength, 0.0f), world_to_image};
}

/// A batch of one, for the scalar forms.
DirectionBatch single(const Vec3& d) {
  DirectionBatch batch;
  batch.push(d);
  batch.pad();
  return batch;
}

}  // namespace

Environment Environment::constant(const Rgb& radiance) {
  Environment e;
  for (int c = 0; c < 3; ++c) e.constant_[c] = std::isfinite(radiance[c]) ? std::max(radiance[c], 0.0f) : 0.0f;
  e.mean_luminance_ = luminance(e.constant_);
  return e;
}

Environment Environment::image(const EquirectangularPixels& pixels, float strength, const Mat3& world_to_image) {
  check(pixels);
  checked(strength, world_to_image);  // before the image is built
  Environment e;
  e.image_ = std::make_shared<const EquirectangularImage>(pixels);
  return e.placed(strength, world_to_image);
}

Environment Environment::placed(float strength, const Mat3& world_to_image) const {
  if (!image_) throw Error(Status::invalid_argument, "The environment has no image, so it cannot be rotated.");
  Environment e = *this;
  e.placement_ = checked(strength, world_to_image);
  e.mean_luminance_ = e.placement_.strength * image_->mean_luminance();
  return e;
}

Environment Environment::load(const std::string& path, const PictureOptions& options, float strength,
                              const Mat3& world_to_image) {
  const Picture picture = read_picture(path, options);
  const EquirectangularPixels pixels{picture.width, picture.height, picture.channels, picture.pixels, true};
  try {
    Environment e = image(pixels, strength, world_to_image);
    e.warnings_ = picture.warnings;
    return e;
  } catch (const Error& error) {
    throw Error(error.status(), path + ": " + error.what());
  }
}

std::vector<Warning> Environment::warnings() const {
  std::vector<Warning> warnings = warnings_;
  if (image_) {
    const auto replaced = fault_warnings(image_->faults(), "");
    warnings.insert(warnings.end(), replaced.begin(), replaced.end());
  }
  return warnings;
}

void Environment::look_up(const DirectionBatch& world, RgbBatch& radiance, ScalarBatch& pdf) const {
  if (image_) return image_->look_up(placement_, world, radiance, pdf);
  for (int i = 0; i < world.count; ++i) {
    radiance.set(i, constant_);
    pdf.v[i] = kUniformPdf;
  }
}

Rgb Environment::radiance(const Vec3& world) const {
  if (!image_) return constant_;
  RgbBatch radiance;
  ScalarBatch pdf;
  image_->look_up(placement_, single(world), radiance, pdf);
  return radiance.get(0);
}

float Environment::pdf(const Vec3& world) const {
  if (!image_) return kUniformPdf;
  RgbBatch radiance;
  ScalarBatch pdf;
  image_->look_up(placement_, single(world), radiance, pdf);
  return pdf.v[0];
}

void Environment::sample(std::span<const Vec2> u, DirectionBatch& world) const {
  if (image_) return image_->sample(placement_, u, world);
  world.count = 0;
  for (const Vec2& v : u) world.push(sample_uniform_sphere(v));
  world.pad();
}

Vec3 Environment::sample(const Vec2& u) const {
  DirectionBatch world;
  sample({&u, 1}, world);
  return world.get(0);
}

uint64_t Environment::bytes() const { return image_ ? image_->bytes() : 0; }

namespace {

constexpr uint32_t kIrradianceDraws = 1024;
constexpr float kMinOfMean = 0.05f;

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

EnvironmentIrradiance::EnvironmentIrradiance(const Environment& sky) {
  if (sky.black()) return;
  least_ = kMinOfMean * kPi * sky.mean_luminance();
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
      const double light = static_cast<double>(luminance(radiance.get(i))) / static_cast<double>(pdf.v[i]);
      const std::array<float, 9> y = harmonics(world.get(i));
      for (size_t k = 0; k < 9; ++k) sum[k] += light * static_cast<double>(y[k]);
    }
  }
  for (size_t k = 0; k < 9; ++k) weight_[k] = kCosine[k] * static_cast<float>(sum[k] / kIrradianceDraws);
}

float EnvironmentIrradiance::on(const Vec3& normal) const {
  const std::array<float, 9> y = harmonics(normal);
  float sum = 0;
  for (size_t k = 0; k < 9; ++k) sum += weight_[k] * y[k];
  return sum > least_ ? sum : least_;  // also where the sum is not a number
}

}  // namespace velour

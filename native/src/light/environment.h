// The environment of the scene: a constant color or an equirectangular image, with matching sampling and density.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>
#include "base/warning.h"
#include "image/picture.h"
#include "math/sphere/directions.h"

namespace velour {

class EquirectangularImage;

/// Borrowed pixels, channels interleaved: 3 or 4 (the 4th is ignored), or 1 or 2 (gray; the 2nd is ignored).
struct EquirectangularPixels {
  int width = 0, height = 0, channels = 0;
  std::span<const float> values;
  bool bottom_up = false;  // true: row 0 is the bottom (-z); false: the top
};

/// Strength and rotation of an environment image.
struct EnvironmentPlacement {
  float strength = 1;         // factor from the image to radiance; negative counts as 0
  Mat3 world_to_image{1.0f};  // rotation of world directions before the look-up
};

/// Radiance from every direction of the world (+z up). Immutable; copies share the image.
///
/// Image coordinates are Blender's: u = 1/2 - atan2(y, x) / (2 pi) from the left, v = 1/2 + asin(z) / pi from the
/// bottom. Radiance is bilinear between texel centers (u wraps, v is clamped to the first and last row). The density of
/// `sample` is the bilinear function with nodes luminance(L) sin(theta) at the texel centers, and 0 at the poles.
class Environment {
 public:
  /// Black.
  Environment() = default;
  /// Negative and non-finite channels count as 0.
  static Environment constant(const Rgb& radiance);
  /// Throws Error(bad_data) for an empty image, a strength that is not finite, or a matrix that is not a rotation.
  /// Negative values and NaN count as 0, infinity as the largest finite value (ValueFaults).
  static Environment image(const EquirectangularPixels& pixels, float strength, const Mat3& world_to_image);
  /// Like image(), from a file that read_picture() reads.
  static Environment load(const std::string& path, const PictureOptions& options, float strength,
                          const Mat3& world_to_image);
  /// Returns the environment with another placement of its shared image, which costs nothing. Throws
  /// Error(invalid_argument) if there is no image.
  Environment placed(float strength, const Mat3& world_to_image) const;

  /// Radiance, and density of `sample` per solid angle, in each direction of `world`, a padded batch.
  void look_up(const DirectionBatch& world, RgbBatch& radiance, ScalarBatch& pdf) const;
  Rgb radiance(const Vec3& world) const;
  /// Samples one world direction for each of up to 64 `u`, with the density of `look_up`. Must not be called if
  /// black().
  void sample(std::span<const Vec2> u, DirectionBatch& world) const;
  Vec3 sample(const Vec2& u) const;
  float pdf(const Vec3& world) const;

  bool black() const { return !(mean_luminance_ > 0.0f); }
  /// Mean over the sphere.
  float mean_luminance() const { return mean_luminance_; }
  uint64_t bytes() const;
  /// Sentences that say what of the image was left out or replaced.
  std::vector<Warning> warnings() const;
  /// The image without its placement; null for a constant environment.
  const EquirectangularImage* equirectangular() const { return image_.get(); }
  const EnvironmentPlacement& placement() const { return placement_; }

 private:
  std::shared_ptr<const EquirectangularImage> image_;
  EnvironmentPlacement placement_;
  Rgb constant_{0.0f};
  float mean_luminance_ = 0.0f;
  std::vector<Warning> warnings_;  // about the file
};

// Unoccluded irradiance of a plane in an environment.

/// Irradiance (luminance) as a function of the plane's normal, as nine spherical harmonics [RH01], from samples of the
/// environment. Accurate to a few per cent, worse on planes that face away from a sun; at least a twentieth of the
/// mean.
class EnvironmentIrradiance {
 public:
  EnvironmentIrradiance() = default;  // black
  explicit EnvironmentIrradiance(const Environment& sky);
  float on(const Vec3& normal) const;

 private:
  std::array<float, 9> weight_{};
  float least_ = 0;
};

}  // namespace velour

// What surrounds the scene: one colour, or an equirectangular image. Look-up, sampling and density belong together.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "image/picture.h"
#include "sphere/direction_batch.h"

namespace velour {

class EquirectangularImage;

/// Borrowed pixels: 3 or 4 channels interleaved (the 4th is not used), or 1 or 2 (gray; the 2nd is not used).
struct EquirectangularPixels {
  int width = 0, height = 0, channels = 0;
  std::span<const float> values;
  bool bottom_up = false;  // row 0 is the bottom (-z), else the top
};

/// How an image surrounds the scene.
struct EnvironmentPlacement {
  float strength = 1;         // radiance is that many times the image; below 0 it counts as 0
  Mat3 world_to_image{1.0f};  // turns a world direction before the look-up
};

/// Radiance from every direction of the world (+z up). Immutable; copies share the image.
///
/// Image coordinates are Blender's: u = 1/2 - atan2(y, x) / (2 pi) from the left, v = 1/2 + asin(z) / pi from the
/// bottom. Radiance is bilinear between texel centres (u wraps, v ends at the first and last row). The density of
/// `sample` is the bilinear function whose nodes are luminance(L) sin(theta) at the texel centres, and 0 at the poles.
class Environment {
 public:
  /// Black.
  Environment() = default;
  /// Negative and non-finite channels count as 0.
  static Environment constant(const Rgb& radiance);
  /// Throws Error(bad_data) on an empty image, or a placement that is none. Negative values and NaN count as 0,
  /// infinity as the largest finite value (ValueFaults).
  static Environment image(const EquirectangularPixels& pixels, float strength, const Mat3& world_to_image);
  /// The same from a file that read_picture() reads.
  static Environment load(const std::string& path, const PictureOptions& options, float strength,
                          const Mat3& world_to_image);
  /// The same image, which is shared, placed otherwise: costs nothing. Throws Error(invalid_argument) where there is
  /// none.
  Environment placed(float strength, const Mat3& world_to_image) const;

  /// Radiance and density (per solid angle, of `sample`) of each direction of `world`. The batch is padded.
  void look_up(const DirectionBatch& world, RgbBatch& radiance, ScalarBatch& pdf) const;
  Rgb radiance(const Vec3& world) const;
  /// World directions, one for each of up to 64 `u`, with the density of `look_up`; not to be called when black().
  void sample(std::span<const Vec2> u, DirectionBatch& world) const;
  Vec3 sample(const Vec2& u) const;
  float pdf(const Vec3& world) const;

  bool black() const { return !(mean_luminance_ > 0.0f); }
  /// Over the sphere.
  float mean_luminance() const { return mean_luminance_; }
  uint64_t bytes() const;
  /// Sentences: what of the image was left out or replaced.
  std::vector<std::string> notes() const;
  /// Null for a constant. As it is by itself, not as it is placed.
  const EquirectangularImage* equirectangular() const { return image_.get(); }
  const EnvironmentPlacement& placement() const { return placement_; }

 private:
  std::shared_ptr<const EquirectangularImage> image_;
  EnvironmentPlacement placement_;
  Rgb constant_{0.0f};
  float mean_luminance_ = 0.0f;
  std::vector<std::string> notes_;  // of the file
};

}  // namespace velour

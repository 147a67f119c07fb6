// The values of a pixel's further passes.
#pragma once

#include <span>
#include <string_view>

#include "render/camera_sample.h"
#include "render/pass_options.h"

namespace velour {

/// The floats of a pixel for the passes that are asked for, one behind the other; nothing for those that are not.
class PassLayout {
 public:
  /// Throws Error(invalid_argument) where `options` make no sense.
  explicit PassLayout(const PassOptions& options);

  /// Floats a pixel.
  size_t size() const { return size_; }

  /// Channels of a pass, asked for or not; 0: there is none of that name. "Position" 3 (world, of the first camera
  /// ray), "UV" 3 (mean; the last: share with texture coordinates), "IndexOB" 1, "IndexMA" 1 (of the first camera ray),
  /// "Mist" 1, "Albedo" 3, "Error" 3, "Denoising Albedo" 3, "Halves" 18 (of the even camera rays color, denoising
  /// albedo and normal, 3 each; of the odd ones the same); "CryptoObject00", "CryptoObject01", ...,
  /// "CryptoMaterial..", "CryptoAsset.." 4: two ids, each followed by its coverage.
  static int channels(std::string_view pass);
  bool has(std::string_view pass) const;

  /// What a camera ray has brought, after those that `before` sums.
  void add(const SurfaceSample& surface, const CameraSample& sample, const PixelSum& before, float* values) const;
  /// What the camera rays of `later` have brought, which come after those that `before` sums.
  void join(const PixelSum& before, std::span<float> values, const PixelSum& later,
            std::span<const float> later_values) const;
  /// The channels of a pass that it has, of one pixel after the other; `values` holds size() of each.
  void write(std::string_view pass, std::span<const PixelSum> sums, std::span<const float> values, float* out) const;

 private:
  size_t floats(uint32_t pass) const;
  size_t place(uint32_t pass) const;

  uint32_t asked_;
  int ranks_;
  size_t size_ = 0;
};

}  // namespace velour

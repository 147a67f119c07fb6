// Storage of the additional passes of a pixel.
#pragma once

#include <span>
#include <string_view>

#include "render/camera_sample.h"
#include "render/pass_options.h"

namespace velour {

/// Floats per pixel of the requested passes, stored one after the other.
class PassLayout {
 public:
  /// Throws Error(invalid_argument) for invalid `options`.
  explicit PassLayout(const PassOptions& options);

  /// Floats per pixel.
  size_t size() const { return size_; }

  /// Channels of a pass, requested or not; 0: there is none of that name. "Position" 3 (world, of the first camera
  /// ray), "UV" 3 (mean; the last: share with texture coordinates), "IndexOB" 1, "IndexMA" 1 (of the first camera ray),
  /// "Mist" 1, "Albedo" 3, "Error" 3, "Denoising Albedo" 3, "Halves" 18 (color, denoising albedo and normal of the even
  /// camera rays, 3 each; then of the odd ones); "CryptoObject00", "CryptoObject01", ..., "CryptoMaterial..",
  /// "CryptoAsset.." 4: two ids, each followed by its coverage.
  static int channels(std::string_view pass);
  bool has(std::string_view pass) const;

  /// Adds a camera ray that follows those summed in `before`.
  void add(const SurfaceSample& surface, const CameraSample& sample, const PixelSum& before, float* values) const;
  /// Adds the camera rays summed in `later`, which follow those summed in `before`.
  void join(const PixelSum& before, std::span<float> values, const PixelSum& later,
            std::span<const float> later_values) const;
  /// Writes the channels of a requested pass, pixel by pixel; `values` holds size() floats per pixel.
  void write(std::string_view pass, std::span<const PixelSum> sums, std::span<const float> values, float* out) const;

 private:
  size_t floats(uint32_t pass) const;
  size_t place(uint32_t pass) const;

  uint32_t asked_;
  int ranks_;
  size_t size_ = 0;
};

}  // namespace velour

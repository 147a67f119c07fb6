// Denoises pictures with Intel's Open Image Denoise.
#pragma once

#include <span>
#include <string>

#include "base/progress.h"
#include "denoise/open_image_denoise.h"

namespace velour {

/// Row-major pixels of 3 floats each: linear HDR color, and the albedo and normals that guide the filter.
struct NoisyPicture {
  int width, height;
  std::span<const float> color, albedo, normal;
};

/// Not thread-safe: each thread needs its own.
class Denoiser {
 public:
  enum class Effort {
    usual,
    least,  // a quarter of the time, for interactive use: a smaller network and unfiltered guides
  };
  /// Throws Error(unsupported) if Open Image Denoise is missing or does not support the processor. `threads` 0: all.
  explicit Denoiser(int threads, Effort effort = Effort::usual);
  ~Denoiser();
  Denoiser(const Denoiser&) = delete;
  Denoiser& operator=(const Denoiser&) = delete;

  /// Writes the colors to `denoised`. Albedo and normals are first filtered separately, so that their noise from depth
  /// of field or fine structure does not reach the picture, which has at least one pixel. Throws Error(cancelled).
  void run(const NoisyPicture& picture, std::span<float> denoised, const Progress& progress);

  /// "2.5.1"
  std::string version() const;
  const std::string& path() const { return oidn_.library.path(); }

 private:
  class Filter;
  void check(const Progress& progress) const;
  void prefilter(const NoisyPicture& picture, const char* name, std::span<const float> noisy, std::span<float> clean,
                 const Progress& progress) const;
  int number() const { return oidn_.GetDeviceInt(device_, "version"); }

  const OpenImageDenoise& oidn_;
  const Effort effort_;
  OpenImageDenoise::Device device_;
};

}  // namespace velour

// Pictures without noise, by Intel's Open Image Denoise.
#pragma once

#include <span>
#include <string>

#include "denoise/open_image_denoise.h"
#include "job/progress.h"

namespace velour {

/// Pixels row by row, 3 floats each: linear light that may be above 1, and what guides the filter.
struct NoisyPicture {
  int width, height;
  std::span<const float> color, albedo, normal;
};

/// One a thread.
class Denoiser {
 public:
  enum class Effort {
    usual,
    least,  // a quarter of the time, for somebody who watches: a smaller net, and guides as they are
  };
  /// Throws Error(unsupported) where Open Image Denoise is missing, or refuses the processor. `threads` 0: all.
  explicit Denoiser(int threads, Effort effort = Effort::usual);
  ~Denoiser();
  Denoiser(const Denoiser&) = delete;
  Denoiser& operator=(const Denoiser&) = delete;

  /// Albedo and normal are filtered first, each by itself, so that the noise of depth of field or of fine structure in
  /// them does not reach the picture. Colors of `denoised`; `picture` has at least one pixel. Throws Error(cancelled).
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

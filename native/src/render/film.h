// The picture being made.
#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <string_view>
#include <vector>

#include "render/pixel_rect.h"
#include "sphere/vec.h"

namespace velour {

/// What one camera ray brings.
struct CameraSample {
  Rgb radiance{0.0f};
  float alpha = 0;      // 1: the pixel is covered
  Vec3 normal{0.0f};    // shading normal, world; zero where nothing was hit
  float depth = 1e10f;  // along the line of sight; as is: nothing was hit (Cycles writes the same)
  int directions = 0;   // light directions that the ray stands for
};

/// Sums a pixel. Samples of a pixel must be added in the order of their camera rays: then the bits do not depend on how
/// the rays are dealt out to passes and threads.
struct PixelSum {
  Rgb radiance{0.0f};
  float alpha = 0;
  Vec3 normal{0.0f};
  float depth = 0;              // of the first camera ray, as Cycles does: a mean of depths lies on no surface
  float luminance[2] = {0, 0};  // of the even and of the odd camera rays: the halves (path_numbers.h)
  uint32_t camera_rays = 0, directions = 0;

  void add(const CameraSample& sample);

  double mean_luminance() const;
  /// Estimate of the variance of mean_luminance(), from the difference of the halves; unbiased where these are
  /// independent, too high where they are parts of one Sobol sequence, which is more even than its parts: what holds
  /// inside a half (a Sobol sequence errs far less than independent samples) is in it. One degree of freedom: to be
  /// averaged over pixels. Needs two camera rays.
  double variance() const;
};

/// Thread-safe: workers publish whole tiles, anyone may read a pass at any time. Row 0 is at the bottom.
class Film {
 public:
  Film(int width, int height) : Film(PixelRect{0, 0, width, height}) {}
  /// Of the pixels of a picture that lie in `window`. Throws Error(invalid_argument) where that is empty.
  explicit Film(const PixelRect& window);
  const PixelRect& window() const { return window_; }
  int width() const { return window_.width(); }
  int height() const { return window_.height(); }

  /// Sets all pixels to nothing.
  void clear();
  /// Copies the sums of `rect`, which lies in the window, row by row, to and from `pixels`.
  void load(const PixelRect& rect, std::span<PixelSum> pixels) const;
  void store(const PixelRect& rect, std::span<const PixelSum> pixels);

  /// Channels of a pass: "Combined" 4 (RGBA, premultiplied), "Depth" 1, "Normal" 3 (world), "Sample Count" 1 (light
  /// directions). Throws Error(invalid_argument) on another name.
  static int channels(std::string_view pass);
  /// `pixels` holds width x height x channels(pass). Pixels without samples are 0; depth is 1e10 where nothing was hit.
  void read_pass(std::string_view pass, std::span<float> pixels) const;
  /// "Combined", but pixels without samples are those of a `coarser` film of the same view; null: they are 0.
  void read_over(const Film* coarser, std::span<float> pixels) const;

  /// Light directions of all pixels.
  uint64_t directions() const;

  /// RMS over the pixels of the standard error of luminance, divided by the mean luminance. 0 while unknown.
  double noise() const;

 private:
  const PixelRect window_;
  mutable std::mutex mutex_;
  std::vector<PixelSum> pixels_;
};

}  // namespace velour

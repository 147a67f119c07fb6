// The image being rendered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string_view>
#include <vector>
#include "denoise/denoiser.h"
#include "render/film/pass_layout.h"
#include "render/options.h"

namespace velour {

/// Thread-safe: workers publish whole tiles, anyone may read a pass at any time. Row 0 is at the bottom.
class Film {
 public:
  Film(int width, int height) : Film(PixelRect{0, 0, width, height}) {}
  /// Film of the pixels of an image that lie in `window`, with the passes of `options` beside those that every film
  /// has. Throws Error(invalid_argument) if the window is empty or the options are invalid.
  explicit Film(const PixelRect& window, PassOptions options = {});
  const PixelRect& window() const { return window_; }
  const PassOptions& options() const { return options_; }
  const PassLayout& layout() const { return layout_; }
  int width() const { return window_.width(); }
  int height() const { return window_.height(); }

  /// Resets all pixels.
  void clear();
  /// Copies the sums of `rect`, which must lie in the window, row by row to and from `pixels`, and with them the values
  /// of layout() for each pixel, unless `values` is empty.
  void load(const PixelRect& rect, std::span<PixelSum> pixels, std::span<float> values = {}) const;
  void store(const PixelRect& rect, std::span<const PixelSum> pixels, std::span<const float> values = {});

  /// Stores denoised colors of the current contents, 3 per pixel, as the pass "Denoised", until the contents change.
  void keep_denoised(std::vector<float> colors, std::optional<DenoisedError> error);
  bool is_denoised() const;
  /// Error of the pass "Denoised"; empty if it is unknown or the film is not denoised.
  std::optional<DenoisedError> denoised_error() const;

  /// Channels of a pass: "Combined" 4 (RGBA, premultiplied), "Depth" 1, "Normal" 3 (world), "Sample Count" 1 (light
  /// directions), "Denoised" 4, and those of PassLayout. Throws Error(invalid_argument) for other names.
  static int channels(std::string_view pass);
  /// `pixels` holds width x height x channels(pass). Pixels without samples are 0; depth is 1e10 where nothing was hit.
  /// Throws Error(invalid_argument) for a pass that was not requested, Error(invalid_state) if it does not exist yet.
  void read_pass(std::string_view pass, std::span<float> pixels) const;
  /// "Combined", with pixels without samples taken from a `coarser` film of the same view; null: they are 0. Throws
  /// Error(invalid_argument) if `pixels` has the wrong size.
  void read_over(const Film* coarser, std::span<float> pixels) const;

  /// Number of light directions of all pixels.
  uint64_t directions() const;

  /// RMS over the pixels of the standard error of luminance, divided by the mean luminance. 0 while unknown.
  double noise() const;

 private:
  void read_layout(std::string_view pass, std::span<float> pixels) const;
  void read_denoised(std::span<float> pixels) const;

  const PixelRect window_;
  const PassOptions options_;
  const PassLayout layout_;
  mutable std::mutex mutex_;
  std::vector<PixelSum> pixels_;
  std::vector<float> values_;    // layout_.size() per pixel
  std::vector<float> denoised_;  // colors; empty: not denoised
  std::optional<DenoisedError> denoised_error_;
};

// A film's sums as plain floats, passed from one run or machine to another.

/// Floats per pixel: those of PixelSum and of the film's layout.
size_t sums_per_pixel(const Film& film);

/// Reads all pixels from the bottom row up, sums_per_pixel() each. Exact: added to an empty film, they reproduce the
/// same bits. Throws Error(invalid_argument) if `sums` has the wrong size, Error(unsupported) if a pixel has more than
/// 2^24 camera rays or light directions, beyond which floats skip integers.
void read_sums(const Film& film, std::span<float> sums);

/// Adds the sums of the camera rays that follow those of `film`, which has the same passes. Throws
/// Error(invalid_argument) if `sums` has the wrong size, Error(bad_data) if it was not written by read_sums(); `film`
/// is unchanged then.
void add_sums(std::span<const float> sums, Film& film);

// Resolution of the first image after a change: as fine as this machine renders at once.

/// Each level halves the pixel size: level 0 is the coarsest, last() has the image's own pixels. An image begins at
/// first().
class FirstLevel {
 public:
  FirstLevel(int width, int height);

  int first() const { return first_; }
  int last() const { return last_; }
  /// Divisor of the sides of the image.
  int divisor(int level) const { return 1 << (last_ - level); }
  /// `seconds`: time taken by the first level, or by a part of it. The next image begins one level coarser or finer if
  /// that fits better.
  void took(double seconds, bool is_whole = true);

 private:
  int last_;
  int finest_;  // finest level that an image may begin at
  int first_;
};

/// Pixels along one side of a level.
constexpr int divided(int side, int divisor) { return (side + divisor - 1) / divisor; }

}  // namespace velour

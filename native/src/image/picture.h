// Pictures of linear float pixels, read from and written to files.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>
#include "base/warning.h"
#include "image/color_primaries.h"

namespace velour {

/// Row 0 is at the bottom; channels are interleaved. Linear values; alpha as stored in the file.
struct Picture {
  int width = 0, height = 0, channels = 0;
  std::vector<float> pixels;
  std::vector<Warning> warnings = {};  // about what was left out or replaced
  const float* pixel(int x, int y) const {
    return pixels.data() + (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) *
                               static_cast<size_t>(channels);
  }
};

/// Transfer curve that linearizes integer formats: the sRGB curve, or stored^gamma.
struct TransferCurve {
  std::optional<float> gamma = std::nullopt;  // empty: sRGB; 1: already linear
};

/// Maximum number of channels of a picture. The sums of a render with all passes have 159.
inline constexpr int kMaxPictureChannels = 256;

struct PictureOptions {
  TransferCurve curve = {};
  std::string layer = {};  // name of a layer or channel of an OpenEXR file; empty: the picture itself
  std::optional<ColorPrimaries> primaries = std::nullopt;  // of files that do not state theirs; empty: Rec. 709
  bool keeps_not_finite = false;                           // keep non-finite values, for measurements, which count them
  /// Pixels as Blender shows them: orientation, exposure, primaries and windows of the header are noted, not applied.
  bool as_stored = false;
};

/// Reads an OpenEXR, Radiance HDR, PNG, JPEG, TIFF or BMP file, recognized by content, as gray, gray and alpha, RGB or
/// RGBA, upright, in linear Rec. 709. OpenEXR: applies choose_exr_colors(), the display window and `chromaticities`.
/// Radiance: applies orientation, EXPOSURE, COLORCORR, PRIMARIES and XYZE. Others: apply the EXIF orientation and the
/// transfer curve. Non-finite values become the largest finite one (+infinity) or 0, and the warnings count them.
/// Throws Error with the file's name, also for files that end early, deep pictures and cube maps. Checks dimensions
/// against the file's size before anything is allocated.
Picture read_picture(const std::string& path, const PictureOptions& options = {});
/// Reads width, height, channels and warnings without the pixels.
Picture read_picture_header(const std::string& path, const PictureOptions& options = {});
/// Reads all channels of the first part of an OpenEXR file as stored, colors first; other files like read_picture().
/// For files written by Velour.
Picture read_picture_channels(const std::string& path);
/// Width, height and channels of read_picture_channels().
Picture read_picture_channels_header(const std::string& path);
/// Text attribute `name` of the header; empty if there is none.
std::optional<std::string> read_picture_text(const std::string& path, const std::string& name);

/// Writes atomically, in the format of the extension: .exr keeps float32, .png has the sRGB curve and 8 bits.
void write_picture(const std::string& path, const Picture& picture);

struct PictureDifference {
  double rmse = 0, relmse = 0;
};
/// What relmse adds to the square of a reference value: 0.01 mean(r)^2. The lower bound only matters for a black image.
inline double relmse_floor(double mean) { return std::max(0.01 * mean * mean, 1e-30); }

/// Compares the first three channels: relmse = mean((x - r)^2 / (r^2 + relmse_floor(mean(r)))).
PictureDifference compare_pictures(const float* pixels, const float* reference, size_t pixel_count, int channels);

// The sRGB transfer curve (IEC 61966-2-1) and its inverse.

inline float linear_from_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }
inline float srgb_from_linear(float v) {
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
}

// Values that are invalid for light, and their replacements.

struct ValueFaults {
  size_t infinite = 0, no_number = 0, negative = 0;  // numbers of such values; no_number: NaN and -infinity
  float brightest = 65504;                           // largest finite value, at least the largest half float

  /// Infinity means "brighter than could be stored" and becomes the brightest value; NaN and -infinity become 0.
  float finite(float v) const { return std::isfinite(v) ? v : (v > 0 ? brightest : 0.0f); }
};

/// Examines the first `used` of every `stride` values.
ValueFaults find_value_faults(std::span<const float> values, size_t stride = 1, size_t used = 1);

/// One warning for each kind that occurs. `file` empty: the environment image.
std::vector<Warning> fault_warnings(const ValueFaults& faults, const std::string& file);

}  // namespace velour

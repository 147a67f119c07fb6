// A picture file opened for reading by the library for its format. Internal to image/.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/warning.h"
#include "image/color_primaries.h"
#include "image/formats/exr_part.h"
#include "image/orientation.h"
#include "image/picture_format.h"

namespace velour {

/// A byte of a DEFLATE stream expands to at most 1032 bytes, each of at most eight 1-bit values.
inline constexpr uint64_t kMaxValuesPerByte = 1032 * 8;

/// A file's claims about its pixels, unchecked.
struct PictureHeader {
  int width = 0, height = 0, depth = 1, channels = 0;  // as stored
  bool integers = false;                               // the values are fractions of the largest integer
  int alpha_channel = -1;                              // -1: none

  Orientation orientation = Orientation::normal;
  std::array<float, 3> scale{1, 1, 1};      // radiance is the stored value times this
  std::optional<ColorPrimaries> primaries;  // empty: Rec. 709 or unknown
  std::optional<PictureFrame> frame;        // set if the stored pixels do not fill the picture exactly
  std::vector<Warning> warnings;            // about what is left out
};

class OpenPicture {
 public:
  virtual ~OpenPicture() = default;
  virtual const PictureHeader& header() const = 0;
  virtual std::optional<std::string> text(const std::string& name) const = 0;
  /// Reads width x height x channels values: rows in stored order, channels interleaved, integers as fractions of the
  /// largest. Throws Error(bad_data) with the library's message, also for a file that ends early.
  virtual void read(std::span<float> values) = 0;
};

/// Error message "FILE: cannot be read as a picture: DETAIL", on one line.
std::string input_error(const std::string& path, std::string detail);

/// Opens the colors of `layer` (choose_exr_colors) of the first part that has them with OpenEXR; 1 to 4 channels.
std::unique_ptr<OpenPicture> open_exr(const std::string& path, const std::string& layer);
/// Opens all channels of the first part with OpenEXR, colors first, in the order R, G, B, A.
std::unique_ptr<OpenPicture> open_exr_channels(const std::string& path);
std::unique_ptr<OpenPicture> open_radiance(const std::string& path);
/// Opens the first picture of the file with libtiff: OpenImageIO (2.4) refuses YCbCr tiles, inverts 16-bit pictures
/// whose 0 is white, and rotates what it converts. Palettes and CMYK become RGB, other color spaces 8-bit RGB.
std::unique_ptr<OpenPicture> open_tiff(const std::string& path);
/// Opens PNG, JPEG and BMP files with OpenImageIO or, in a library without it, with stb_image and libjpeg.
std::unique_ptr<OpenPicture> open_integers(const std::string& path, PictureFormat format);

/// Encodes an 8-bit PNG file; the top row comes first.
std::vector<uint8_t> png_of(const std::string& path, int width, int height, int channels,
                            std::span<const uint8_t> values);
/// Writes 32-bit floats atomically, with lossless compression. The top row of `top_first` comes first.
void write_exr(const std::string& path, const Picture& top_first, const PictureFrame& frame, const PictureTexts& texts);

}  // namespace velour

// A picture file opened for reading, by whichever library knows its format. Internal to image/.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/color_primaries.h"
#include "image/exr_part.h"
#include "image/orientation.h"
#include "image/picture_format.h"

namespace velour {

/// A byte of a DEFLATE stream makes at most 1032 bytes, and a byte at most eight 1-bit values.
inline constexpr uint64_t kMaxValuesPerByte = 1032 * 8;

/// What a file says of its pixels; nothing of it is checked.
struct PictureHeader {
  int width = 0, height = 0, depth = 1, channels = 0;  // as stored
  bool integers = false;                               // the values are shares of the largest integer
  int alpha_channel = -1;                              // none

  Orientation orientation = Orientation::normal;
  std::array<float, 3> scale{1, 1, 1};      // radiance is the stored value times this
  std::optional<ColorPrimaries> primaries;  // nothing: Rec. 709, or unknown
  std::optional<PictureFrame> frame;        // the stored pixels lie in a picture of another size
  std::vector<std::string> notes;           // sentences without the file's name: what of the file is left out
};

class OpenPicture {
 public:
  virtual ~OpenPicture() = default;
  virtual const PictureHeader& header() const = 0;
  virtual std::optional<std::string> text(const std::string& name) const = 0;
  /// Stored order of rows, channels interleaved: width x height x channels values, integers as shares of the largest.
  /// Throws Error(bad_data) with the library's own words, also for a file that ends early.
  virtual void read(std::span<float> values) = 0;
};

/// "FILE: cannot be read as a picture: DETAIL", on one line.
std::string input_error(const std::string& path, std::string detail);

/// By OpenEXR: the colors of `layer` (choose_exr_colors) of the first part that has them, 1 to 4 channels.
std::unique_ptr<OpenPicture> open_exr(const std::string& path, const std::string& layer);
/// By OpenEXR: all channels of the first part, colors first, in the order R, G, B, A.
std::unique_ptr<OpenPicture> open_exr_channels(const std::string& path);
std::unique_ptr<OpenPicture> open_radiance(const std::string& path);
/// By libtiff, and not by OpenImageIO, which refuses tiles of YCbCr, inverts 16 bits whose 0 is white, and turns what
/// it converts (2.4): the first picture of the file. Palettes and CMYK become RGB, other color spaces 8 bits of RGB.
std::unique_ptr<OpenPicture> open_tiff(const std::string& path);
/// PNG, JPEG and BMP: by OpenImageIO, or in a library without it by those that it would use.
std::unique_ptr<OpenPicture> open_integers(const std::string& path, PictureFormat format);

/// Bytes of a PNG file of 8 bits; top row first.
std::vector<uint8_t> png_of(const std::string& path, int width, int height, int channels,
                            std::span<const uint8_t> values);
/// Writes 32-bit floats, losslessly compressed; `top_first` has its top row first. Atomic.
void write_exr(const std::string& path, const Picture& top_first, const PictureFrame& frame, const PictureTexts& texts);

}  // namespace velour

// A picture file opened for reading, by whichever library knows its format. For picture.cpp alone.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/exr_part.h"

namespace velour {

/// A byte of a DEFLATE stream makes at most 1032 bytes, and a byte at most eight 1-bit values.
inline constexpr uint64_t kMaxValuesPerByte = 1032 * 8;

class OpenPicture {
 public:
  /// As the header says; nothing of it is checked.
  struct Format {
    int width = 0, height = 0, depth = 1, channels = 0;
    bool integers = false;
    int alpha_channel = -1;  // none
  };

  virtual ~OpenPicture() = default;
  virtual Format format() const = 0;
  virtual std::optional<std::string> text(const std::string& name) const = 0;
  /// Top row first, channels interleaved: width x height x channels values, integers as shares of the largest. Throws
  /// Error(bad_data) with the library's own words, also for a file that ends early.
  virtual void read(std::span<float> values) = 0;
};

/// "FILE: cannot be read as a picture: DETAIL", on one line.
std::string input_error(const std::string& path, std::string detail);

/// By OpenEXR: scan lines or tiles; the first part. Colours come first, in the order R, G, B, A.
std::unique_ptr<OpenPicture> open_exr(const std::string& path);
/// All other formats: by OpenImageIO, or in a library without it by stb_image (PNG, JPEG, BMP, Radiance HDR).
std::unique_ptr<OpenPicture> open_other_format(const std::string& path);

/// Bytes of a PNG file of 8 bits; top row first.
std::vector<uint8_t> png_of(const std::string& path, int width, int height, int channels,
                            std::span<const uint8_t> values);
/// Writes 32-bit floats, losslessly compressed; `top_first` has its top row first. Atomic.
void write_exr(const std::string& path, const Picture& top_first, const PictureFrame& frame, const PictureTexts& texts);

}  // namespace velour

// Picture files before they are decoded: their format, their orientation, and the interface of an open file. Internal
// to image/.
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
#include "image/formats/exr_picture.h"
#include "image/picture.h"

namespace velour {

// Recognizes the format of a picture file by its first bytes.

enum class PictureFormat { exr, radiance, png, jpeg, tiff, bmp };

/// Number of bytes that picture_format_of() examines; shorter files have fewer.
inline constexpr size_t kPictureHeadBytes = 16;

/// Throws Error(unsupported) for any other content, naming the file, its format if known, and the supported formats.
PictureFormat picture_format_of(std::span<const uint8_t> head, const std::string& path);

// Orientation of a picture's stored rows and columns in the upright picture.

/// Values of EXIF and TIFF (tag 274): the sides of the upright picture where the stored row 0 and column 0 lie.
enum class Orientation {
  normal = 1,       // top, left
  mirrored = 2,     // top, right
  turned_180 = 3,   // bottom, right
  flipped = 4,      // bottom, left
  transposed = 5,   // left, top
  turned_cw = 6,    // right, top: must be rotated clockwise by 90 degrees
  transversed = 7,  // right, bottom
  turned_ccw = 8,   // left, bottom: must be rotated counterclockwise by 90 degrees
};

inline bool swaps_sides(Orientation o) { return o >= Orientation::transposed; }

/// Returns the upright picture. The top row comes first in memory in both.
Picture upright(Picture stored, Orientation orientation);

// The orientation that cameras and editors store in a picture file (EXIF 2.3, tag 274).

/// Orientation stored in a JPEG (APP1 segment) or PNG file (eXIf chunk); normal if it is missing or invalid. Reads only
/// a few bytes of the file.
Orientation exif_orientation(PictureFormat format, const std::string& path);

/// Throws Error(bad_data) for a PNG file with a chunk that extends beyond the file: libraries allocate the stated size
/// of a chunk before they read it. Refuses Apple's own variant as well, which some libraries read with red and blue
/// swapped. Returns the bits of a pixel as stored, an index if it is of a palette; 1 if the header states none.
int check_png_chunks(const std::string& path);

// The color space that a file of integers states. Velour treats all of them as sRGB.

/// Name of the color space of an ICC profile (ICC.1:2022); empty if it is sRGB or its grays, also under another name:
/// primaries within 0.01 in XYZ, and half of the largest value within 0.02. A damaged profile is empty, too.
std::string other_color_space(std::span<const uint8_t> icc_profile);
/// The same for a JPEG (APP2 segments) or PNG file (chunks cICP, iCCP, sRGB, gAMA, cHRM, the first of which counts).
/// Empty for other formats.
std::string other_color_space(PictureFormat format, const std::string& path);

// A picture file opened for reading by the library for its format. Internal to image/.

/// A byte of a DEFLATE stream expands to at most 1032 bytes.
inline constexpr uint64_t kMaxExpansion = 1032;

/// A file's claims about its pixels, unchecked.
struct PictureHeader {
  int width = 0, height = 0, depth = 1, channels = 0;  // as stored
  bool integers = false;                               // the values are fractions of the largest integer
  int alpha_channel = -1;                              // -1: none
  bool is_xyz = false;                                 // channels named X, Y and Z stand for colors

  Orientation orientation = Orientation::normal;
  std::array<float, 3> scale{1, 1, 1};      // radiance is the stored value times this
  std::optional<ColorPrimaries> primaries;  // empty: Rec. 709 or unknown
  std::optional<PictureFrame> frame;        // set if the stored pixels do not fill the picture exactly
  std::vector<Warning> warnings;            // about what is left out

  /// Adds the warning about a color space (other_color_space), unless it is empty.
  void note_color_space(const std::string& path, const std::string& space);
};

class OpenPicture {
 public:
  virtual ~OpenPicture() = default;
  virtual const PictureHeader& header() const = 0;
  virtual std::optional<std::string> text(const std::string& name) const = 0;
  /// Reads width x height x channels values: rows in stored order, channels interleaved, integers as fractions of the
  /// largest. Throws Error(bad_data) with the library's message, also for a file that ends early.
  virtual void read(std::span<float> values) = 0;
  /// Maximum number of bytes of pixels per byte of the file.
  virtual uint64_t expansion() const { return kMaxExpansion; }
};

/// Error message "FILE: cannot be read as a picture: DETAIL", on one line.
std::string input_error(const std::string& path, std::string detail);

/// Opens the colors of `layer` (choose_exr_colors) with OpenEXR; 1 to 4 channels. Without a layer, of the first part
/// with R, G or B, else with Y, else with a single channel or X, Y and Z.
std::unique_ptr<OpenPicture> open_exr(const std::string& path, const std::string& layer);
/// Opens all channels of the first part with OpenEXR, colors first, in the order R, G, B, A.
std::unique_ptr<OpenPicture> open_exr_channels(const std::string& path);
std::unique_ptr<OpenPicture> open_radiance(const std::string& path);
/// Opens the first picture of full size with libtiff: OpenImageIO (2.4) refuses YCbCr tiles, inverts 16-bit pictures
/// whose 0 is white, and rotates what it converts. Palettes, CMYK and LogLuv become RGB, other color spaces 8-bit RGB.
std::unique_ptr<OpenPicture> open_tiff(const std::string& path);
std::unique_ptr<OpenPicture> open_bmp(const std::string& path);
/// Opens PNG and JPEG files with OpenImageIO or, in a library without it, with stb_image and libjpeg.
std::unique_ptr<OpenPicture> open_integers(const std::string& path, PictureFormat format);

/// Encodes an 8-bit PNG file; the top row comes first.
std::vector<uint8_t> png_of(const std::string& path, int width, int height, int channels,
                            std::span<const uint8_t> values);
/// Writes 32-bit floats atomically, with lossless compression. The top row of `top_first` comes first.
void write_exr(const std::string& path, const Picture& top_first, const PictureFrame& frame, const PictureTexts& texts);

}  // namespace velour

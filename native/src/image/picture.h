// Pictures: linear float pixels, read and written through OpenEXR and OpenImageIO.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "image/color_primaries.h"

namespace velour {

/// Row 0 is at the bottom; channels interleaved. Linear values; alpha as the file holds it.
struct Picture {
  int width = 0, height = 0, channels = 0;
  std::vector<float> pixels;
  std::vector<std::string> notes = {};  // sentences with the file's name: what of it was left out or replaced
  const float* pixel(int x, int y) const {
    return pixels.data() + (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) *
                               static_cast<size_t>(channels);
  }
};

/// How the pixels of integer formats become linear: by the sRGB curve, or as stored^gamma.
struct TransferCurve {
  std::optional<float> gamma = std::nullopt;  // nothing: sRGB; 1: they are linear already
};

struct PictureOptions {
  TransferCurve curve = {};
  std::string layer = {};  // of an OpenEXR file: the name of a layer or channel; empty: the picture itself
  std::optional<ColorPrimaries> primaries = std::nullopt;  // of files that do not state theirs; nothing: Rec. 709
  bool keeps_not_finite = false;  // values that are not finite stay: for measurements, which count them
  /// Pixels as Blender shows them: what the header says of orientation, exposure, primaries and windows is noted, not
  /// applied.
  bool as_stored = false;
};

/// The picture of an OpenEXR, Radiance HDR, PNG, JPEG, TIFF or BMP file, recognized by content: gray, gray and alpha,
/// RGB or RGBA, upright, in linear Rec. 709. OpenEXR: see choose_exr_colors(); the display window; `chromaticities`.
/// Radiance: all orientations, EXPOSURE, COLORCORR, PRIMARIES, XYZE. Others: EXIF orientation, the curve. Values that
/// are not finite become the largest finite one (+infinity) or 0, and are counted in the notes. Throws Error with the
/// file's name, also for a file that ends early and for deep pictures and cube maps. Dimensions are checked against the
/// file's size before anything is allocated.
Picture read_picture(const std::string& path, const PictureOptions& options = {});
/// Width, height, channels and notes without the pixels.
Picture read_picture_header(const std::string& path, const PictureOptions& options = {});
/// All channels of the first part of an OpenEXR file as they are stored, colors first; other files as read_picture().
/// For files that Velour wrote.
Picture read_picture_channels(const std::string& path);
/// Width, height and channels of the same.
Picture read_picture_channels_header(const std::string& path);
/// The text of that name in the header; nothing where there is none.
std::optional<std::string> read_picture_text(const std::string& path, const std::string& name);

/// By extension: .exr keeps float32, .png gets the sRGB curve and 8 bits. Atomic.
void write_picture(const std::string& path, const Picture& picture);

struct PictureDifference {
  double rmse = 0, relmse = 0;
};
/// Of the first three channels: relmse = mean((x - r)^2 / (r^2 + 0.01 mean(r)^2)).
PictureDifference compare_pictures(const float* pixels, const float* reference, size_t pixel_count, int channels);

}  // namespace velour

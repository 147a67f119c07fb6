// Pictures: linear float pixels, read and written through OpenEXR and OpenImageIO.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace velour {

/// Row 0 is at the bottom; channels interleaved. Linear values; alpha as the file holds it.
struct Picture {
  int width = 0, height = 0, channels = 0;
  std::vector<float> pixels;
  const float* pixel(int x, int y) const {
    return pixels.data() + (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) *
                               static_cast<size_t>(channels);
  }
};

/// How the pixels of integer formats become linear: by the sRGB curve, or as stored^gamma.
struct TransferCurve {
  std::optional<float> gamma = std::nullopt;  // nothing: sRGB; 1: they are linear already
};

/// Any format OpenImageIO knows (a library without it: EXR, PNG, JPEG, BMP, Radiance HDR); integer formats are made
/// linear, floats are taken as they are. Throws Error with the file's name, also for a file that ends early. Dimensions
/// are checked against the file's size before anything is allocated.
Picture read_picture(const std::string& path, const TransferCurve& curve = {});
/// Width, height, channels without the pixels.
Picture read_picture_header(const std::string& path);
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

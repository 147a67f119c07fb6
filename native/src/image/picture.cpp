#include "image/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>

#include "file/file.h"
#include "image/open_picture.h"
#include "image/srgb.h"
#include "job/error.h"

namespace velour {
namespace {

constexpr uint64_t kMaxValues = uint64_t{1} << 30;
constexpr int kMaxChannels = 64;
constexpr std::array<uint8_t, 4> kExrMagic{0x76, 0x2f, 0x31, 0x01};

/// Nearest 8-bit code; not a number and negative values give 0.
uint8_t srgb_byte(float linear) {
  const float v = linear > 0.0f ? srgb_from_linear(std::min(linear, 1.0f)) : 0.0f;
  return static_cast<uint8_t>(std::lround(v * 255.0f));
}

/// The limits of OpenEXR and OpenImageIO are the process's (Blender shares them) and stay as they are, so sizes are
/// checked here.
void check_size(const std::string& path, const OpenPicture::Format& format) {
  const std::string size = std::to_string(format.width) + " x " + std::to_string(format.height) + " x " +
                           std::to_string(format.channels) + " channels";
  if (format.width <= 0 || format.height <= 0 || format.depth > 1 || format.channels <= 0 ||
      format.channels > kMaxChannels)
    throw Error(Status::bad_data, path + ": the header says " + size + ", which is no flat picture.");
  const uint64_t pixels = static_cast<uint64_t>(format.width) * static_cast<uint64_t>(format.height);
  const uint64_t bound = std::min(kMaxValues, kMaxValuesPerByte * std::filesystem::file_size(path));
  if (pixels > bound / static_cast<uint64_t>(format.channels))
    throw Error(Status::bad_data, path + ": the header says " + size + ", more than the file can hold.");
}

std::unique_ptr<OpenPicture> open_picture(const std::string& path) {
  const auto head = read_file_head(path, kExrMagic.size());  // says plainly what is wrong with the path
  auto input = std::ranges::equal(head, kExrMagic) ? open_exr(path) : open_other_format(path);
  check_size(path, input->format());
  return input;
}

Picture picture_of(const OpenPicture::Format& format) { return {format.width, format.height, format.channels, {}}; }

/// Files store the top row first.
void flip_rows(Picture& picture) {
  const auto row = static_cast<std::ptrdiff_t>(picture.width) * picture.channels;
  const auto begin = picture.pixels.begin();
  for (std::ptrdiff_t low = 0, high = picture.height - 1; low < high; ++low, --high)
    std::swap_ranges(begin + low * row, begin + (low + 1) * row, begin + high * row);
}

void make_linear(Picture& picture, int alpha_channel, const TransferCurve& curve) {
  const auto linear = [&](float v) { return curve.gamma ? std::pow(v, *curve.gamma) : linear_from_srgb(v); };
  for (size_t i = 0; i < picture.pixels.size(); ++i)
    if (static_cast<int>(i % static_cast<size_t>(picture.channels)) != alpha_channel)
      picture.pixels[i] = linear(picture.pixels[i]);
}

void write_png(const std::string& path, const Picture& picture) {
  std::vector<uint8_t> bytes(picture.pixels.size());
  const bool has_alpha = picture.channels == 2 || picture.channels == 4;
  for (size_t i = 0; i < bytes.size(); ++i) {
    const bool alpha = has_alpha && static_cast<int>(i % static_cast<size_t>(picture.channels)) == picture.channels - 1;
    bytes[i] = alpha ? static_cast<uint8_t>(std::lround(std::clamp(picture.pixels[i], 0.0f, 1.0f) * 255.0f))
                     : srgb_byte(picture.pixels[i]);
  }
  write_file(path, png_of(path, picture.width, picture.height, picture.channels, bytes));
}

/// `picture` as files store it; its size is checked.
Picture top_first(const std::string& path, const Picture& picture) {
  const uint64_t count = static_cast<uint64_t>(picture.width) * static_cast<uint64_t>(picture.height) *
                         static_cast<uint64_t>(picture.channels);
  if (picture.width <= 0 || picture.height <= 0 || picture.channels <= 0 || count != picture.pixels.size()) {
    throw Error(Status::invalid_argument, path + ": the picture has " + std::to_string(picture.pixels.size()) +
                                              " values, not width x height x channels.");
  }
  Picture flipped = picture;
  flip_rows(flipped);
  return flipped;
}

}  // namespace

std::string input_error(const std::string& path, std::string detail) {
  std::ranges::replace(detail, '\n', ' ');  // readers may say several sentences, a line each
  return path + ": cannot be read as a picture" + (detail.empty() ? "." : ": " + detail);
}

Picture read_picture_header(const std::string& path) { return picture_of(open_picture(path)->format()); }

std::optional<std::string> read_picture_text(const std::string& path, const std::string& name) {
  return open_picture(path)->text(name);
}

Picture read_picture(const std::string& path, const TransferCurve& curve) {
  const auto input = open_picture(path);
  const OpenPicture::Format format = input->format();
  Picture picture = picture_of(format);
  picture.pixels.resize(static_cast<size_t>(format.width) * static_cast<size_t>(format.height) *
                        static_cast<size_t>(format.channels));
  input->read(picture.pixels);
  flip_rows(picture);
  if (format.integers) make_linear(picture, format.alpha_channel, curve);
  return picture;
}

void write_picture(const std::string& path, const Picture& picture) {
  const auto extension = std::filesystem::path(path).extension();
  if (extension == ".png") return write_png(path, top_first(path, picture));
  write_exr_part(path, picture, {picture.width, picture.height, 0, 0}, {});
}

void write_exr_part(const std::string& path, const Picture& picture, const PictureFrame& frame,
                    const PictureTexts& texts) {
  if (std::filesystem::path(path).extension() != ".exr") {
    throw Error(Status::unsupported, path + ": pictures are written as .exr or .png, parts of them as .exr.");
  }
  write_exr(path, top_first(path, picture), frame, texts);
}

PictureDifference compare_pictures(const float* pixels, const float* reference, size_t pixel_count, int channels) {
  const int used = std::min(channels, 3);
  const double count = static_cast<double>(pixel_count) * used;
  double mean = 0;
  const auto each = [&](auto&& visit) {
    for (size_t p = 0; p < pixel_count; ++p)
      for (int c = 0; c < used; ++c) {
        const size_t i = p * static_cast<size_t>(channels) + static_cast<size_t>(c);
        visit(static_cast<double>(pixels[i]), static_cast<double>(reference[i]));
      }
  };
  each([&](double, double r) { mean += r / count; });
  // The floor only matters where the reference is black as a whole.
  const double floor = std::max(0.01 * mean * mean, 1e-30);
  PictureDifference difference;
  each([&](double x, double r) {
    difference.rmse += (x - r) * (x - r) / count;
    difference.relmse += (x - r) * (x - r) / (r * r + floor) / count;
  });
  difference.rmse = std::sqrt(difference.rmse);
  return difference;
}

}  // namespace velour

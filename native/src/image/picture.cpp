#include "image/picture.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>

#include "file/file.h"
#include "job/error.h"

namespace velour {
namespace {

/// A byte of a DEFLATE stream makes at most 1032 bytes, and a byte at most eight 1-bit values.
constexpr uint64_t kMaxValuesPerByte = 1032 * 8;
constexpr uint64_t kMaxValues = uint64_t{1} << 30;
constexpr int kMaxChannels = 64;

/// IEC 61966-2-1.
float linear_from_srgb(float v) { return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f); }
float srgb_from_linear(float v) { return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f; }

/// Nearest 8-bit code; not a number and negative values give 0.
uint8_t srgb_byte(float linear) {
  const float v = linear > 0.0f ? srgb_from_linear(std::min(linear, 1.0f)) : 0.0f;
  return static_cast<uint8_t>(std::lround(v * 255.0f));
}

/// Readers may say several sentences, a line each.
std::string input_error(const std::string& path, std::string detail) {
  std::ranges::replace(detail, '\n', ' ');
  return path + ": cannot be read as a picture" + (detail.empty() ? "." : ": " + detail);
}

/// The process's own limits of OpenImageIO stay as they are (Blender shares them), so sizes are checked here.
void check_size(const std::string& path, const OIIO::ImageSpec& spec) {
  const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height) + " x " +
                           std::to_string(spec.nchannels) + " channels";
  if (spec.width <= 0 || spec.height <= 0 || spec.depth > 1 || spec.nchannels <= 0 || spec.nchannels > kMaxChannels)
    throw Error(Status::bad_data, path + ": the header says " + size + ", which is no flat picture.");
  const uint64_t pixels = static_cast<uint64_t>(spec.width) * static_cast<uint64_t>(spec.height);
  const uint64_t bound = std::min(kMaxValues, kMaxValuesPerByte * std::filesystem::file_size(path));
  if (pixels > bound / static_cast<uint64_t>(spec.nchannels))
    throw Error(Status::bad_data, path + ": the header says " + size + ", more than the file can hold.");
}

/// OpenEXR makes tables for all rows that a header claims when it opens a file, before anyone can ask how many.
void check_exr_rows(const std::string& path) {
  constexpr size_t kMostHeader = 65536, kBegin = 8;
  const auto head = read_file_head(path, kMostHeader);
  const std::string text(head.begin(), head.end());
  if (!text.starts_with("\x76\x2f\x31\x01")) return;
  for (size_t at = kBegin; at < text.size() && text[at] != 0;) {  // name, type, size, value
    const std::string name = text.c_str() + at;
    at += name.size() + 1;
    at = text.find('\0', at);
    uint32_t size = 0;
    if (at == std::string::npos || text.size() - at < 1 + sizeof size) return;
    std::memcpy(&size, text.data() + at + 1, sizeof size);
    at += 1 + sizeof size;
    if (size > std::filesystem::file_size(path) - at) throw Error(Status::bad_data, path + ": its header is damaged.");
    if (size > text.size() - at) return;
    std::array<int32_t, 4> window{};  // least x, y, most x, y
    if (name == "dataWindow" && size == sizeof window) {
      std::memcpy(window.data(), text.data() + at, sizeof window);
      const int64_t rows = int64_t{window[3]} - window[1] + 1;
      if (rows > static_cast<int64_t>(kMaxValuesPerByte * std::filesystem::file_size(path))) {
        throw Error(Status::bad_data,
                    path + ": the header says " + std::to_string(rows) + " rows, more than the file can hold.");
      }
    }
    at += size;
  }
}

std::unique_ptr<OIIO::ImageInput> open_picture(const std::string& path) {
  read_file_head(path, 1);  // says plainly what is wrong with the path
  check_exr_rows(path);
  OIIO::ImageSpec request;
  request.attribute("oiio:UnassociatedAlpha",
                    1);  // channels as stored: no product with alpha before the sRGB curve
  auto input = OIIO::ImageInput::open(path, &request);
  if (!input) throw Error(Status::bad_data, input_error(path, OIIO::geterror()));
  check_size(path, input->spec());
  return input;
}

Picture picture_of(const OIIO::ImageSpec& spec) { return {spec.width, spec.height, spec.nchannels, {}}; }

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

/// Encodes into memory first, so that the file appears whole or not at all.
void encode(const std::string& path, OIIO::ImageSpec spec, OIIO::TypeDesc type, const void* pixels) {
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput memory(bytes);
  auto output = OIIO::ImageOutput::create(path);
  if (!output) throw Error(Status::unsupported, path + ": OpenImageIO cannot write this format here.");
  output->set_ioproxy(&memory);
  if (!output->open(path, spec) || !output->write_image(type, pixels) || !output->close())
    throw Error(Status::io, path + ": cannot encode the picture: " + output->geterror());
  write_file(path, bytes);
}

void write_exr(const std::string& path, const Picture& picture) {
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, OIIO::TypeDesc::FLOAT);
  spec.attribute("compression", "zip");
  encode(path, spec, OIIO::TypeDesc::FLOAT, picture.pixels.data());
}

void write_png(const std::string& path, const Picture& picture) {
  std::vector<uint8_t> bytes(picture.pixels.size());
  const bool has_alpha = picture.channels == 2 || picture.channels == 4;
  for (size_t i = 0; i < bytes.size(); ++i) {
    const bool alpha = has_alpha && static_cast<int>(i % static_cast<size_t>(picture.channels)) == picture.channels - 1;
    bytes[i] = alpha ? static_cast<uint8_t>(std::lround(std::clamp(picture.pixels[i], 0.0f, 1.0f) * 255.0f))
                     : srgb_byte(picture.pixels[i]);
  }
  OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  encode(path, spec, OIIO::TypeDesc::UINT8, bytes.data());
}

}  // namespace

Picture read_picture_header(const std::string& path) { return picture_of(open_picture(path)->spec()); }

std::optional<std::string> read_picture_text(const std::string& path, const std::string& name) {
  const auto input = open_picture(path);
  const OIIO::ParamValue* found = input->spec().find_attribute(name, OIIO::TypeDesc::STRING);
  return found ? std::optional(found->get_string()) : std::nullopt;
}

Picture read_picture(const std::string& path, const TransferCurve& curve) {
  const auto input = open_picture(path);
  const OIIO::ImageSpec spec = input->spec();
  Picture picture = picture_of(spec);
  picture.pixels.resize(static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height) *
                        static_cast<size_t>(spec.nchannels));
  const bool read = input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, picture.pixels.data());
  // Of a JPEG or TIFF that ends early it says so, and that all is well.
  if (!read || input->has_error()) throw Error(Status::bad_data, input_error(path, input->geterror()));
  flip_rows(picture);
  if (!spec.format.is_floating_point()) make_linear(picture, spec.alpha_channel, curve);
  return picture;
}

void write_picture(const std::string& path, const Picture& picture) {
  const uint64_t count = static_cast<uint64_t>(picture.width) * static_cast<uint64_t>(picture.height) *
                         static_cast<uint64_t>(picture.channels);
  if (picture.width <= 0 || picture.height <= 0 || picture.channels <= 0 || count != picture.pixels.size())
    throw Error(Status::invalid_argument, path + ": the picture has " + std::to_string(picture.pixels.size()) +
                                              " values, not width x height x channels.");
  Picture top_first = picture;
  flip_rows(top_first);
  const auto extension = std::filesystem::path(path).extension();
  if (extension == ".exr") return write_exr(path, top_first);
  if (extension == ".png") return write_png(path, top_first);
  throw Error(Status::unsupported, path + ": pictures are written as .exr or .png.");
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

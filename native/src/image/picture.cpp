#include "image/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <limits>
#include <memory>
#include "base/error.h"
#include "base/file.h"
#include "image/open_picture.h"

namespace velour {

namespace {

constexpr uint64_t kMaxValues = uint64_t{1} << 30;

/// Nearest 8-bit code; NaN and negative values give 0.
uint8_t srgb_byte(float linear) {
  const float v = linear > 0.0f ? srgb_from_linear(std::min(linear, 1.0f)) : 0.0f;
  return static_cast<uint8_t>(std::lround(v * 255.0f));
}

std::string size_text(int width, int height, int channels) {
  return std::to_string(width) + " x " + std::to_string(height) + " x " + std::to_string(channels) + " channels";
}

/// The size limits of OpenEXR and OpenImageIO are global to the process, which may be Blender's, and are left alone, so
/// sizes are checked here.
/// `pixel_bits`: at least so many are stored per pixel; 0: one per channel.
void check_size(const std::string& path, const OpenPicture& input, int pixel_bits, uint64_t max_values) {
  const PictureHeader& header = input.header();
  const std::string size = size_text(header.width, header.height, header.channels);
  if (header.channels > kMaxPictureChannels)
    throw Error(Status::unsupported, path + ": the image has " + std::to_string(header.channels) +
                                         " channels, but only " + std::to_string(kMaxPictureChannels) +
                                         " are supported. Save it with fewer passes.");
  if (header.width <= 0 || header.height <= 0 || header.depth > 1 || header.channels <= 0)
    throw Error(Status::bad_data, path + ": the header claims " + size + ", which is not a valid flat image.");
  const uint64_t pixels = static_cast<uint64_t>(header.width) * static_cast<uint64_t>(header.height);
  if (pixels > max_values / static_cast<uint64_t>(header.channels))
    throw Error(Status::unsupported, path + ": has " + size + ", but only " + std::to_string(max_values) +
                                         " values are supported. Scale the image down.");
  const auto bits = static_cast<uint64_t>(pixel_bits > 0 ? pixel_bits : header.channels);
  if (pixels > input.expansion() * 8 * std::filesystem::file_size(path) / bits)
    throw Error(Status::bad_data,
                path + ": the header claims " + size + ", more than the file can contain; the file is damaged.");
}

/// Limits the size of a picture of which the file contains only a part.
void check_frame(const std::string& path, const PictureHeader& header) {
  constexpr uint64_t kAlwaysAllowed = uint64_t{1} << 24, kTimesStored = 64;
  if (!header.frame) return;
  const int width = header.frame->width, height = header.frame->height;
  const uint64_t stored = static_cast<uint64_t>(header.width) * static_cast<uint64_t>(header.height);
  const uint64_t whole = static_cast<uint64_t>(std::max(width, 0)) * static_cast<uint64_t>(std::max(height, 0));
  const uint64_t bound =
      std::min(kMaxValues / static_cast<uint64_t>(header.channels), std::max(kAlwaysAllowed, kTimesStored * stored));
  if (width <= 0 || height <= 0 || whole > bound)
    throw Error(Status::bad_data, path + ": its display window is " + std::to_string(width) + " x " +
                                      std::to_string(height) + " pixels, but its data window is only " +
                                      std::to_string(header.width) + " x " + std::to_string(header.height) +
                                      ". Save the image without the crop; otherwise the file is damaged.");
}

PictureFormat format_of(const std::string& path) {
  return picture_format_of(read_file_head(path, kPictureHeadBytes), path);  // clear error message about a bad path
}

std::unique_ptr<OpenPicture> checked(const std::string& path, std::unique_ptr<OpenPicture> input, int pixel_bits = 0,
                                     uint64_t max_values = kMaxValues) {
  check_size(path, *input, pixel_bits, max_values);
  check_frame(path, input->header());
  return input;
}

std::unique_ptr<OpenPicture> open_picture(const std::string& path, const std::string& layer) {
  const PictureFormat format = format_of(path);
  if (format == PictureFormat::exr) return checked(path, open_exr(path, layer));
  if (!layer.empty()) {
    throw Error(Status::unsupported, path + ": has no layer '" + layer +
                                         "', because only OpenEXR files have layers. Do not choose a layer.");
  }
  // The former run lengths of Radiance have no bound of their own; only a picture of one color exceeds this one.
  if (format == PictureFormat::radiance) return checked(path, open_radiance(path), 24);
  if (format == PictureFormat::tiff) return checked(path, open_tiff(path));
  if (format == PictureFormat::bmp) return checked(path, open_bmp(path));
  const int pixel_bits = format == PictureFormat::png ? check_png_chunks(path) : 0;
  return checked(path, open_integers(path, format), pixel_bits);
}

std::unique_ptr<OpenPicture> open_channels(const std::string& path) {
  if (format_of(path) != PictureFormat::exr) return open_picture(path, "");
  // Velour's own renders have as many values as their pixels and passes need; the file's size bounds them.
  return checked(path, open_exr_channels(path), 0, std::numeric_limits<uint64_t>::max());
}

bool is_scaled(const PictureHeader& header) { return header.scale != std::array<float, 3>{1, 1, 1}; }

const std::optional<ColorPrimaries>& primaries_of(const PictureHeader& header, const PictureOptions& options) {
  return header.primaries ? header.primaries : options.primaries;
}

/// Warnings about the header and, for options.as_stored, about what Blender ignores in it.
std::vector<Warning> warnings_of(const std::string& path, const PictureHeader& header, const PictureOptions& options) {
  std::vector<Warning> warnings = header.warnings;
  if (!options.as_stored) {
    const bool is_guess = header.is_xyz && !primaries_of(header, options);
    if (is_guess) warnings.push_back(warning<WarningCode::xyz_as_rgb>({{"file", path}}));
    return warnings;
  }
  if (header.orientation != Orientation::normal) {
    warnings.push_back(warning<WarningCode::orientation_ignored>(
        {{"file", path}, {"orientation", static_cast<uint64_t>(header.orientation)}}));
  }
  if (is_scaled(header)) warnings.push_back(warning<WarningCode::exposure_ignored>({{"file", path}}));
  if (header.primaries && !is_rec709(*header.primaries)) {
    warnings.push_back(warning<WarningCode::primaries_ignored>({{"file", path}}));
  }
  if (header.frame) {
    warnings.push_back(warning<WarningCode::window_ignored>({{"file", path},
                                                             {"width", static_cast<uint64_t>(header.frame->width)},
                                                             {"height", static_cast<uint64_t>(header.frame->height)}}));
  }
  return warnings;
}

/// The picture without its pixels.
Picture picture_of(const std::string& path, const PictureHeader& header, const PictureOptions& options) {
  Picture picture{header.width, header.height, header.channels, {}, warnings_of(path, header, options)};
  if (options.as_stored) return picture;
  if (header.frame) {
    picture.width = header.frame->width;
    picture.height = header.frame->height;
  }
  if (swaps_sides(header.orientation)) std::swap(picture.width, picture.height);
  return picture;
}

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

/// Adds what it replaces to `replaced`. Keeps negative values: differences and out-of-gamut colors have them.
void replace_not_finite(Picture& picture, ValueFaults& replaced) {
  const ValueFaults faults = find_value_faults(picture.pixels);
  if (faults.infinite + faults.no_number == 0) return;
  std::ranges::transform(picture.pixels, picture.pixels.begin(), [&](float v) { return faults.finite(v); });
  if (faults.infinite > 0) replaced.brightest = faults.brightest;
  replaced.infinite += faults.infinite;
  replaced.no_number += faults.no_number;
}

void scale_colors(Picture& picture, const std::array<float, 3>& scale) {
  const auto channels = static_cast<size_t>(picture.channels);
  for (size_t i = 0; i < picture.pixels.size(); i += channels)
    for (size_t c = 0; c < 3; ++c) picture.pixels[i + c] *= scale[c];
}

void apply_primaries(Picture& picture, const ColorPrimaries& primaries, const std::string& path) {
  if (picture.channels < 3 || is_rec709(primaries)) return;
  const auto matrix = to_rec709(primaries);
  if (!matrix) {
    throw Error(Status::bad_data, path + ": its chromaticities are not valid color primaries. Correct or remove them.");
  }
  transform_colors(*matrix, static_cast<size_t>(picture.channels), picture.pixels);
}

/// Places `part`, row 0 at the bottom, in its whole picture, which is black elsewhere.
Picture placed(const Picture& part, const PictureFrame& frame) {
  Picture whole{frame.width, frame.height, part.channels, {}};
  const auto channels = static_cast<size_t>(part.channels);
  whole.pixels.assign(static_cast<size_t>(frame.width) * static_cast<size_t>(frame.height) * channels, 0.0f);
  const int64_t left = std::max<int64_t>(frame.x, 0);
  const int64_t right = std::min<int64_t>(int64_t{frame.x} + part.width, frame.width);
  const int64_t bottom = std::max<int64_t>(frame.y, 0);
  const int64_t top = std::min<int64_t>(int64_t{frame.y} + part.height, frame.height);
  for (int64_t y = bottom; y < top && left < right; ++y) {
    const float* from = part.pixel(static_cast<int>(left - frame.x), static_cast<int>(y - frame.y));
    const size_t to =
        (static_cast<size_t>(y) * static_cast<size_t>(frame.width) + static_cast<size_t>(left)) * channels;
    std::copy_n(from, static_cast<size_t>(right - left) * channels,
                whole.pixels.begin() + static_cast<std::ptrdiff_t>(to));
  }
  return whole;
}

/// Reads the pixels in stored order.
Picture stored_pixels(OpenPicture& input) {
  const PictureHeader& header = input.header();
  Picture picture{header.width, header.height, header.channels, {}};
  picture.pixels.resize(static_cast<size_t>(header.width) * static_cast<size_t>(header.height) *
                        static_cast<size_t>(header.channels));
  input.read(picture.pixels);
  return picture;
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

/// `picture` with its top row first, as files store it. Checks its size.
Picture top_first(const std::string& path, const Picture& picture) {
  const uint64_t count = static_cast<uint64_t>(picture.width) * static_cast<uint64_t>(picture.height) *
                         static_cast<uint64_t>(picture.channels);
  if (picture.width <= 0 || picture.height <= 0 || picture.channels <= 0 || count != picture.pixels.size()) {
    throw Error(Status::invalid_argument, path + ": the image has " + std::to_string(picture.pixels.size()) +
                                              " values, which does not match width x height x channels.");
  }
  Picture flipped = picture;
  flip_rows(flipped);
  return flipped;
}

}  // namespace

std::string input_error(const std::string& path, std::string detail) {
  std::ranges::replace(detail, '\n', ' ');  // libraries may report several sentences, one per line
  return path + ": cannot be read as an image" + (detail.empty() ? "." : ": " + detail);
}

Picture read_picture_header(const std::string& path, const PictureOptions& options) {
  return picture_of(path, open_picture(path, options.layer)->header(), options);
}

Picture read_picture_channels_header(const std::string& path) {
  return picture_of(path, open_channels(path)->header(), {});
}

std::optional<std::string> read_picture_text(const std::string& path, const std::string& name) {
  return open_channels(path)->text(name);
}

Picture read_picture(const std::string& path, const PictureOptions& options) {
  const auto input = open_picture(path, options.layer);
  const PictureHeader& header = input->header();
  Picture picture = stored_pixels(*input);
  if (header.integers) make_linear(picture, header.alpha_channel, options.curve);
  ValueFaults replaced;
  if (!options.keeps_not_finite) replace_not_finite(picture, replaced);
  if (!options.as_stored) {
    if (is_scaled(header)) scale_colors(picture, header.scale);
    if (const auto& primaries = primaries_of(header, options)) apply_primaries(picture, *primaries, path);
    // An exposure or a matrix may make finite values infinite.
    if (!options.keeps_not_finite) replace_not_finite(picture, replaced);
    picture = upright(std::move(picture), header.orientation);
  }
  flip_rows(picture);
  if (header.frame && !options.as_stored) picture = placed(picture, *header.frame);
  picture.warnings = warnings_of(path, header, options);
  std::ranges::move(fault_warnings(replaced, path), std::back_inserter(picture.warnings));
  return picture;
}

Picture read_picture_channels(const std::string& path) {
  if (format_of(path) != PictureFormat::exr) return read_picture(path);
  Picture picture = stored_pixels(*open_channels(path));
  flip_rows(picture);
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
    throw Error(Status::unsupported,
                path + ": images can only be written as .exr or .png, and parts of images only as .exr.");
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
  const double floor = relmse_floor(mean);
  PictureDifference difference;
  each([&](double x, double r) {
    difference.rmse += (x - r) * (x - r) / count;
    difference.relmse += (x - r) * (x - r) / (r * r + floor) / count;
  });
  difference.rmse = std::sqrt(difference.rmse);
  return difference;
}

ValueFaults find_value_faults(std::span<const float> values, size_t stride, size_t used) {
  ValueFaults faults;
  for (size_t first = 0; first + used <= values.size(); first += stride) {
    for (const float v : values.subspan(first, used)) {
      if (std::isfinite(v)) {
        faults.negative += v < 0;
        faults.brightest = std::max(faults.brightest, v);
      } else {
        ++(v > 0 ? faults.infinite : faults.no_number);
      }
    }
  }
  return faults;
}

std::vector<Warning> fault_warnings(const ValueFaults& faults, const std::string& file) {
  std::vector<Warning> warnings;
  if (faults.infinite > 0) {
    warnings.push_back(warning<WarningCode::infinite_values>(
        {{"file", file}, {"values", faults.infinite}, {"replacement", faults.brightest}}));
  }
  if (faults.no_number > 0) {
    warnings.push_back(warning<WarningCode::nan_values>({{"file", file}, {"values", faults.no_number}}));
  }
  if (faults.negative > 0) {
    warnings.push_back(warning<WarningCode::negative_values>({{"file", file}, {"values", faults.negative}}));
  }
  return warnings;
}

}  // namespace velour

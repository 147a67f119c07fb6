#include <algorithm>

#include "capi/conversions.h"
#include "capi/guard.h"
#include "capi/reports/reports.h"
#include "image/formats/exr_picture.h"

using namespace velour;
using namespace velour::capi;

namespace {

Picture checked_picture(uint32_t width, uint32_t height, uint32_t channels) {
  constexpr uint32_t kLargest = 65536;
  if (width == 0 || height == 0 || channels == 0 || width > kLargest || height > kLargest ||
      channels > kMaxPictureChannels) {
    throw Error(Status::invalid_argument, "An image cannot have " + std::to_string(width) + " x " +
                                              std::to_string(height) + " pixels and " + std::to_string(channels) +
                                              " channels; 1 to 65536 pixels along each side and 1 to " +
                                              std::to_string(kMaxPictureChannels) + " channels are supported.");
  }
  return {static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels), {}};
}

PictureFrame converted(const vlr_image_frame& given, const Picture& part) {
  vlr_image_frame frame = read_options(
      &given, +[](vlr_image_frame* empty) { *empty = {}; }, "vlr_image_frame");
  checked_picture(frame.width, frame.height, 1);
  const bool inside = frame.x >= 0 && frame.y >= 0 && frame.x <= static_cast<int64_t>(frame.width) - part.width &&
                      frame.y <= static_cast<int64_t>(frame.height) - part.height;
  if (!inside) {
    throw Error(Status::invalid_argument,
                "An image part of " + std::to_string(part.width) + " x " + std::to_string(part.height) + " pixels at " +
                    std::to_string(frame.x) + ", " + std::to_string(frame.y) + " does not fit into an image of " +
                    std::to_string(frame.width) + " x " + std::to_string(frame.height) + " pixels.");
  }
  return {static_cast<int>(frame.width), static_cast<int>(frame.height), frame.x, frame.y};
}

/// Warnings of this thread's last vlr_picture_read.
std::vector<Warning>& last_read_warnings() {
  thread_local std::vector<Warning> warnings;
  return warnings;
}

struct PictureOutput {
  uint32_t *width, *height, *channels;
  float* pixels;  // null: only the size is requested
  uint64_t count;
};

void hand_out(const Picture& picture, const PictureOutput& to) {
  *to.width = static_cast<uint32_t>(picture.width);
  *to.height = static_cast<uint32_t>(picture.height);
  *to.channels = static_cast<uint32_t>(picture.channels);
  if (!to.pixels) return;
  if (to.count != picture.pixels.size()) {
    throw Error(Status::invalid_argument, "count is " + std::to_string(to.count) + ", but the image has " +
                                              std::to_string(picture.pixels.size()) + " values.");
  }
  std::copy(picture.pixels.begin(), picture.pixels.end(), to.pixels);
}

}  // namespace

vlr_status vlr_image_write(const char* path, uint32_t width, uint32_t height, uint32_t channels, const float* pixels) {
  return guard([&] {
    require(path, "path");
    require(pixels, "pixels");
    Picture picture = checked_picture(width, height, channels);
    picture.pixels.assign(pixels, pixels + static_cast<size_t>(width) * height * channels);
    write_picture(path, picture);
  });
}

vlr_status vlr_image_read(const char* path, uint32_t* width, uint32_t* height, uint32_t* channels, float* pixels,
                          uint64_t count) {
  return guard([&] {
    require(path, "path");
    require(width, "width");
    require(height, "height");
    require(channels, "channels");
    hand_out(pixels ? read_picture_channels(path) : read_picture_channels_header(path),
             {width, height, channels, pixels, count});
  });
}

void vlr_picture_options_init(vlr_picture_options* options) {
  *options = {};
  options->struct_size = sizeof(vlr_picture_options);
}

vlr_status vlr_picture_read(const char* path, const vlr_picture_options* options, uint32_t* width, uint32_t* height,
                            uint32_t* channels, float* pixels, uint64_t count) {
  return guard([&] {
    require(path, "path");
    require(width, "width");
    require(height, "height");
    require(channels, "channels");
    const PictureOptions given = converted(options);
    Picture picture = pixels ? read_picture(path, given) : read_picture_header(path, given);
    hand_out(picture, {width, height, channels, pixels, count});
    if (pixels) last_read_warnings() = std::move(picture.warnings);
  });
}

vlr_status vlr_picture_notes_json(const char* path, const vlr_picture_options* options, const char** json) {
  return guard([&] {
    require(json, "json");
    thread_local std::string said;
    said = text(warnings_json(path ? read_picture_header(path, converted(options)).warnings : last_read_warnings()));
    *json = said.c_str();
  });
}

vlr_status vlr_image_write_part(const char* path, uint32_t width, uint32_t height, uint32_t channels,
                                const float* pixels, const vlr_image_frame* frame, const char* const* texts,
                                uint32_t text_count) {
  return guard([&] {
    require(path, "path");
    require(pixels, "pixels");
    if (text_count > 0) require(texts, "texts");
    Picture picture = checked_picture(width, height, channels);
    const PictureFrame place = frame ? converted(*frame, picture) : PictureFrame{picture.width, picture.height, 0, 0};
    PictureTexts named;
    for (uint32_t i = 0; i < text_count; ++i) {
      require(texts[2 * i], "texts");
      require(texts[2 * i + 1], "texts");
      named[texts[2 * i]] = texts[2 * i + 1];
    }
    picture.pixels.assign(pixels, pixels + static_cast<size_t>(width) * height * channels);
    write_exr_part(path, picture, place, named);
  });
}

vlr_status vlr_image_header_json(const char* path, const char** json) {
  return guard([&] {
    require(path, "path");
    require(json, "json");
    const ExrHeader header = read_exr_header(path);
    const PictureFrame& frame = header.frame;
    thread_local std::string said;
    said = text({{"width", header.width},
                 {"height", header.height},
                 {"channels", header.channels},
                 {"frame", {{"width", frame.width}, {"height", frame.height}, {"x", frame.x}, {"y", frame.y}}},
                 {"multi_part", header.multi_part},
                 {"texts", header.texts}});
    *json = said.c_str();
  });
}

vlr_status vlr_image_compare(uint64_t pixel_count, uint32_t channels, const float* pixels, const float* reference,
                             double* rmse, double* relmse) {
  return guard([&] {
    require(pixels, "pixels");
    require(reference, "reference");
    require(rmse, "rmse");
    require(relmse, "relmse");
    if (pixel_count == 0 || channels < 3) {
      throw Error(Status::invalid_argument, "Only images with at least one pixel and three channels can be compared.");
    }
    const PictureDifference d =
        compare_pictures(pixels, reference, static_cast<size_t>(pixel_count), static_cast<int>(channels));
    *rmse = d.rmse;
    *relmse = d.relmse;
  });
}

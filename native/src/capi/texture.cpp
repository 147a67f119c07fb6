#include "material/texture.h"

#include <iterator>

#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/surfaces.h"
#include "image/picture.h"

using namespace velour;
using namespace velour::capi;

namespace {

TextureOptions converted(const vlr_texture_options& options) {
  require_choice(options.wrap, VLR_WRAP_MIRROR, "vlr_texture_options.wrap");
  require_choice(options.filter, VLR_FILTER_LINEAR, "vlr_texture_options.filter");
  return {static_cast<TextureWrap>(options.wrap), static_cast<TextureFilter>(options.filter)};
}

struct Pixels {
  int width, height, channels;
  const float* first;
  size_t count() const { return static_cast<size_t>(width) * static_cast<size_t>(height); }
  const float* at(size_t i) const { return first + i * static_cast<size_t>(channels); }
};

vlr_texture* texture_of(const Pixels& pixels, const vlr_texture_options& options) {
  if (options.channel < -1 || options.channel >= pixels.channels) {
    throw Error(Status::invalid_argument, "vlr_texture_options.channel is " + std::to_string(options.channel) +
                                              ", but the image has " + std::to_string(pixels.channels) +
                                              " channels; use -1 (colors) or an existing channel.");
  }
  const TextureOptions converted_options = converted(options);
  auto texture = std::make_unique<vlr_texture>();
  if (options.channel >= 0) {
    std::vector<float> texels(pixels.count());
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = pixels.at(i)[options.channel];
    texture->number =
        std::make_shared<const Texture<float>>(pixels.width, pixels.height, std::move(texels), converted_options);
  } else {
    const int second = pixels.channels < 3 ? 0 : 1;
    std::vector<Rgb> texels(pixels.count());
    for (size_t i = 0; i < texels.size(); ++i) {
      texels[i] = {pixels.at(i)[0], pixels.at(i)[second], pixels.at(i)[2 * second]};
    }
    texture->color =
        std::make_shared<const Texture<Rgb>>(pixels.width, pixels.height, std::move(texels), converted_options);
  }
  return texture.release();
}

}  // namespace

void vlr_texture_options_init(vlr_texture_options* options) {
  *options = {};
  options->struct_size = sizeof(vlr_texture_options);
  options->filter = VLR_FILTER_LINEAR;
  options->channel = -1;
}

vlr_status vlr_texture_create(uint32_t width, uint32_t height, uint32_t channels, const float* pixels,
                              const vlr_texture_options* options, vlr_texture** out) {
  return guard([&] {
    require(pixels, "pixels");
    require(out, "out");
    constexpr uint32_t kLargest = 65536, kMostChannels = 64;
    if (width == 0 || height == 0 || channels == 0 || width > kLargest || height > kLargest ||
        channels > kMostChannels) {
      throw Error(Status::invalid_argument,
                  "A texture cannot have " + std::to_string(width) + " x " + std::to_string(height) + " pixels and " +
                      std::to_string(channels) +
                      " channels; 1 to 65536 pixels along each side and 1 to 64 channels are supported.");
    }
    const auto given = read_options(options, vlr_texture_options_init, "vlr_texture_options");
    *out = texture_of({static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels), pixels}, given);
  });
}

vlr_status vlr_texture_of_corners(uint32_t set, vlr_texture** out) {
  return guard([&] {
    require(out, "out");
    static_assert(VLR_MOST_COLOR_SETS == SurfaceSite::kMostColorSets);
    if (set >= VLR_MOST_COLOR_SETS) {
      throw Error(Status::invalid_argument, "There is no corner color set " + std::to_string(set) +
                                                "; a material has sets 0 to " +
                                                std::to_string(VLR_MOST_COLOR_SETS - 1) + ".");
    }
    auto texture = std::make_unique<vlr_texture>();
    texture->corner_colors = set;
    *out = texture.release();
  });
}

vlr_status vlr_texture_load(const char* path, const vlr_texture_options* options, vlr_texture** out) {
  return guard([&] {
    require(path, "path");
    require(out, "out");
    const auto given = read_options(options, vlr_texture_options_init, "vlr_texture_options");
    const Picture picture = read_picture(path, {.curve = given.raw != 0 ? TransferCurve{1.0f} : TransferCurve{}});
    *out = texture_of({picture.width, picture.height, picture.channels, picture.pixels.data()}, given);
  });
}

void vlr_texture_free(vlr_texture* texture) { delete texture; }

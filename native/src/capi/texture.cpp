#include "material/texture.h"

#include <iterator>

#include "capi/guard.h"
#include "capi/handles.h"
#include "capi/texture_maps.h"
#include "image/picture.h"
#include "material/principled_material.h"
#include "material/principled_textures.h"

using namespace velour;
using namespace velour::capi;

namespace {

void require_choice(int32_t value, int32_t last, const char* field) {
  if (value >= 0 && value <= last) return;
  throw Error(Status::invalid_argument, "vlr_texture_options." + std::string(field) + " is " + std::to_string(value) +
                                            "; it is one of 0 to " + std::to_string(last) + ".");
}

TextureOptions converted(const vlr_texture_options& options) {
  require_choice(options.wrap, VLR_WRAP_MIRROR, "wrap");
  require_choice(options.filter, VLR_FILTER_LINEAR, "filter");
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
                                              "; the picture has " + std::to_string(pixels.channels) + ".");
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

[[noreturn]] void refuse_kind(const char* field, const char* needed) {
  throw Error(Status::invalid_argument,
              "vlr_principled_textures." + std::string(field) + " needs a texture of " + needed + ".");
}

TextureSlot<Rgb> color_slot(const vlr_texture* texture, const float* map, const char* field) {
  if (texture != nullptr && !texture->color) refuse_kind(field, "colours (channel -1)");
  return {texture != nullptr ? texture->color : nullptr, map_from(map)};
}

TextureSlot<float> number_slot(const vlr_texture* texture, const float* map, const char* field) {
  if (texture != nullptr && !texture->number) refuse_kind(field, "numbers (a channel)");
  return {texture != nullptr ? texture->number : nullptr, map_from(map)};
}

PrincipledTextures converted(const vlr_principled_textures& t) {
  return {color_slot(t.base_color, t.base_color_map, "base_color"), number_slot(t.metallic, t.metallic_map, "metallic"),
          number_slot(t.roughness, t.roughness_map, "roughness"), number_slot(t.alpha, t.alpha_map, "alpha")};
}

PrincipledParameters parameters_of(const vlr_principled_desc& desc) {
  return {.base_color = {desc.base_color[0], desc.base_color[1], desc.base_color[2]},
          .metallic = desc.metallic,
          .roughness = desc.roughness,
          .specular = desc.specular};
}

/// A uniform material knows its albedos more cheaply.
std::shared_ptr<const Material> material_of(const vlr_principled_desc& desc, const PrincipledTextures& textures) {
  if (!textures.any() && desc.alpha >= 1.0f) return make_principled_material(parameters_of(desc));
  return make_textured_material(parameters_of(desc), textures, desc.alpha);
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
      throw Error(Status::invalid_argument, "A texture of " + std::to_string(width) + " x " + std::to_string(height) +
                                                " pixels and " + std::to_string(channels) +
                                                " channels cannot be used; sides go to 65536, channels to 64.");
    }
    const auto given = read_options(options, vlr_texture_options_init, "vlr_texture_options");
    *out = texture_of({static_cast<int>(width), static_cast<int>(height), static_cast<int>(channels), pixels}, given);
  });
}

vlr_status vlr_texture_load(const char* path, const vlr_texture_options* options, vlr_texture** out) {
  return guard([&] {
    require(path, "path");
    require(out, "out");
    const auto given = read_options(options, vlr_texture_options_init, "vlr_texture_options");
    const Picture picture = read_picture(path, given.raw != 0 ? TransferCurve{1.0f} : TransferCurve{});
    *out = texture_of({picture.width, picture.height, picture.channels, picture.pixels.data()}, given);
  });
}

void vlr_texture_free(vlr_texture* texture) { delete texture; }

void vlr_principled_textures_init(vlr_principled_textures* textures) {
  *textures = {};
  textures->struct_size = sizeof(vlr_principled_textures);
  for (float* map : {textures->base_color_map, textures->metallic_map, textures->roughness_map, textures->alpha_map}) {
    map[0] = map[4] = 1.0f;
  }
}

vlr_status vlr_scene_add_textured_material(vlr_scene* scene, const vlr_principled_desc* desc,
                                           const vlr_principled_textures* textures, uint32_t* material) {
  return guard([&] {
    require(scene, "scene");
    require(material, "material");
    const auto given = read_options(desc, vlr_principled_desc_init, "vlr_principled_desc");
    const auto pictures = read_options(textures, vlr_principled_textures_init, "vlr_principled_textures");
    *material = scene->scene->add_material({.material = material_of(given, converted(pictures)),
                                            .emission = {given.emission[0], given.emission[1], given.emission[2]},
                                            .rec709_colors = false});
  });
}

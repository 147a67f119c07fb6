#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <string>

#include "capi/conversions.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "image/picture.h"
#include "material/principled/principled_material.h"
#include "material/program/program.h"
#include "material/texture.h"

using namespace velour;
using namespace velour::capi;

namespace velour::capi {

namespace {

[[noreturn]] void refuse_kind(const char* field, const char* needed) {
  throw Error(Status::invalid_argument, std::string(field) + " requires a texture of " + needed + ".");
}

static_assert(VLR_MOST_UV_SETS == SurfaceSite::kMaxSets);

size_t known_set(uint32_t set, const char* field) {
  if (set < SurfaceSite::kMaxSets) return set;
  throw Error(Status::invalid_argument, std::string(field) + " uses UV set " + std::to_string(set) +
                                            "; a material has UV sets 0 to " +
                                            std::to_string(SurfaceSite::kMaxSets - 1) + ".");
}

}  // namespace

TextureSlot<Rgb> color_slot(const vlr_texture* texture, const float* map, uint32_t set, const char* field) {
  if (texture == nullptr) return {};
  if (texture->program) return TextureSlot<Rgb>::output_of(texture->program, texture->output);
  if (texture->corner_colors) return TextureSlot<Rgb>::colors_of_corners(*texture->corner_colors);
  if (!texture->color) refuse_kind(field, "colors (channel -1)");
  return {texture->color, map_from(map), known_set(set, field)};
}

TextureSlot<float> number_slot(const vlr_texture* texture, const float* map, uint32_t set, const char* field) {
  if (texture == nullptr) return {};
  if (texture->program) return TextureSlot<float>::output_of(texture->program, texture->output);
  if (texture->corner_colors) return TextureSlot<float>::colors_of_corners(*texture->corner_colors);
  if (!texture->number) refuse_kind(field, "numbers (channel 0 or higher)");
  return {texture->number, map_from(map), known_set(set, field)};
}

MeshSets sets_of(const PrincipledTextures& t) {
  MeshSets sets;
  sets.add(t.base_color);
  sets.add(t.metallic);
  sets.add(t.roughness);
  sets.add(t.alpha);
  for (const auto& [parameter, slot] : t.numbers) sets.add(slot);
  for (const auto& [parameter, slot] : t.colors) sets.add(slot);
  return sets;
}

void use_sets(SurfaceMaterial& surface, const MeshSets& sets, uint32_t opacity_outputs) {
  surface.uv_sets = sets.uvs;
  surface.color_sets = sets.colors;
  if (!sets.program) return;
  surface.program = sets.program->only(sets.outputs);
  surface.relief |= surface.program->has_relief();
  if (opacity_outputs != 0 && !surface.material->opaque()) surface.opacity = sets.program->only(opacity_outputs);
}

namespace {

constexpr float PrincipledParameters::*kNumbers[] = {
    &PrincipledParameters::specular,       &PrincipledParameters::coat,
    &PrincipledParameters::coat_roughness, &PrincipledParameters::coat_index,
    &PrincipledParameters::transmission,   &PrincipledParameters::transmission_roughness,
    &PrincipledParameters::index,          &PrincipledParameters::sheen,
    &PrincipledParameters::sheen_roughness};
constexpr Rgb PrincipledParameters::*kColors[] = {&PrincipledParameters::specular_tint,
                                                  &PrincipledParameters::coat_tint, &PrincipledParameters::sheen_tint};
static_assert(std::size(kNumbers) == VLR_PARAMETER_SPECULAR_TINT);
static_assert(std::size(kColors) == VLR_PARAMETER_SHEEN_TINT - VLR_PARAMETER_SPECULAR_TINT + 1);

void add_texture(PrincipledTextures& to, const vlr_parameter_texture& t) {
  constexpr const char* kField = "vlr_principled_textures.more";
  require_choice(t.parameter, VLR_PARAMETER_SHEEN_TINT, "vlr_parameter_texture.parameter");
  require(t.texture, "vlr_parameter_texture.texture");
  const auto parameter = static_cast<size_t>(t.parameter);
  if (parameter < std::size(kNumbers)) {
    to.numbers.push_back({kNumbers[parameter], number_slot(t.texture, t.map, t.set, kField)});
  } else {
    to.colors.push_back({kColors[parameter - std::size(kNumbers)], color_slot(t.texture, t.map, t.set, kField)});
  }
}

}  // namespace

PrincipledTextures converted_textures(const vlr_principled_textures& t) {
  PrincipledTextures textures{
      color_slot(t.base_color, t.base_color_map, t.base_color_set, "vlr_principled_textures.base_color"),
      number_slot(t.metallic, t.metallic_map, t.metallic_set, "vlr_principled_textures.metallic"),
      number_slot(t.roughness, t.roughness_map, t.roughness_set, "vlr_principled_textures.roughness"),
      number_slot(t.alpha, t.alpha_map, t.alpha_set, "vlr_principled_textures.alpha")};
  if (t.more_count > 0) require(t.more, "vlr_principled_textures.more");
  for (uint32_t i = 0; i < t.more_count; ++i) add_texture(textures, t.more[i]);
  return textures;
}

static_assert(VLR_PRINCIPLED_DISNEY == static_cast<int>(PrincipledFormula::disney));
static_assert(VLR_GGX_SINGLE == static_cast<int>(GgxLobe::single));
static_assert(VLR_GGX_SEPARABLE == static_cast<int>(GgxLobe::separable));

GgxLobe lobe_of(const vlr_principled_desc& desc) {
  require_choice(desc.lobe, VLR_GGX_SEPARABLE, "vlr_principled_desc.lobe");
  return static_cast<GgxLobe>(desc.lobe);
}

PrincipledParameters parameters_of(const vlr_principled_desc& desc) {
  require_choice(desc.formula, VLR_PRINCIPLED_DISNEY, "vlr_principled_desc.formula");
  require_choice(desc.coat_lobe, VLR_GGX_SINGLE, "vlr_principled_desc.coat_lobe");
  require_choice(desc.glass_fresnel, VLR_GLASS_SURFACE, "vlr_principled_desc.glass_fresnel");
  if (!(desc.index > 0) || !std::isfinite(desc.index)) {
    throw Error(Status::invalid_argument, "vlr_principled_desc.index is " + std::to_string(desc.index) +
                                              "; an index of refraction must be finite and above 0.");
  }
  const auto color = [](const float* c) { return Rgb(c[0], c[1], c[2]); };
  return {.base_color = color(desc.base_color),
          .metallic = desc.metallic,
          .roughness = desc.roughness,
          .specular = desc.specular,
          .specular_tint = color(desc.specular_tint),
          .coat = desc.coat,
          .coat_roughness = desc.coat_roughness,
          .coat_index = desc.coat_index,
          .coat_tint = color(desc.coat_tint),
          .transmission = desc.transmission,
          .transmission_roughness = desc.transmission_roughness,
          .index = desc.index,
          .sheen = desc.sheen,
          .sheen_roughness = desc.sheen_roughness,
          .sheen_tint = color(desc.sheen_tint),
          .specular_of_index = desc.specular_of_index != 0,
          .formula = static_cast<PrincipledFormula>(desc.formula),
          .lobe = lobe_of(desc),
          .coat_lobe = static_cast<GgxLobe>(desc.coat_lobe)};
}

std::shared_ptr<const Material> material_of(const vlr_principled_desc& desc, const PrincipledTextures& textures) {
  return make_principled_material(parameters_of(desc), textures, desc.alpha);
}

}  // namespace velour::capi

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
    const auto pictures =
        converted_textures(read_options(textures, vlr_principled_textures_init, "vlr_principled_textures"));
    SurfaceMaterial surface{.material = material_of(given, pictures),
                            .emission = {given.emission[0], given.emission[1], given.emission[2]},
                            .rec709_colors = false,
                            .turned = turned_material(given, pictures)};
    MeshSets opacity;
    opacity.add(pictures.alpha);
    use_sets(surface, sets_of(pictures), opacity.outputs);
    *material = scene->scene->add_material(std::move(surface));
  });
}

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

/// The first component of its colors is what options.channel selects.
StoredTexels stored_texels(const Pixels& pixels, const vlr_texture_options& options) {
  if (pixels.channels != 4 || options.channel > 2) {
    throw Error(
        Status::invalid_argument,
        "vlr_texture_options.srgb and premultiplied need images of 4 channels and a channel up to 2; these have " +
            std::to_string(pixels.channels) + ", and channel is " + std::to_string(options.channel) + ".");
  }
  StoredTexels stored;
  stored.srgb = options.srgb != 0;
  stored.premultiplied = options.premultiplied != 0;
  stored.texels.resize(pixels.count());
  std::memcpy(stored.texels.data(), pixels.first, pixels.count() * sizeof(glm::vec4));
  const auto row = [&](int i) {
    return Rgb(options.colors[3 * i], options.colors[3 * i + 1], options.colors[3 * i + 2]);
  };
  const int first = std::max(options.channel, 0);
  stored.colors = glm::transpose(Mat3(row(first), row((first + 1) % 3), row((first + 2) % 3)));
  return stored;
}

vlr_texture* texture_of(const Pixels& pixels, const vlr_texture_options& options) {
  if (options.channel < -1 || options.channel >= pixels.channels) {
    throw Error(Status::invalid_argument, "vlr_texture_options.channel is " + std::to_string(options.channel) +
                                              ", but the image has " + std::to_string(pixels.channels) +
                                              " channels; use -1 (colors) or an existing channel.");
  }
  const TextureOptions converted_options = converted(options);
  auto texture = std::make_unique<vlr_texture>();
  const auto made = [&](auto kind, auto texels) {
    return std::make_shared<const Texture<decltype(kind)>>(pixels.width, pixels.height, std::move(texels),
                                                           converted_options);
  };
  const bool is_stored = options.srgb != 0 || options.premultiplied != 0;
  if (is_stored && options.channel >= 0) {
    texture->number = made(float(), stored_texels(pixels, options));
  } else if (is_stored) {
    texture->color = made(Rgb(), stored_texels(pixels, options));
  } else if (options.channel >= 0) {
    std::vector<float> texels(pixels.count());
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = pixels.at(i)[options.channel];
    texture->number = made(float(), std::move(texels));
  } else {
    const int second = pixels.channels < 3 ? 0 : 1;
    std::vector<Rgb> texels(pixels.count());
    for (size_t i = 0; i < texels.size(); ++i) {
      texels[i] = {pixels.at(i)[0], pixels.at(i)[second], pixels.at(i)[2 * second]};
    }
    texture->color = made(Rgb(), std::move(texels));
  }
  return texture.release();
}

}  // namespace

void vlr_texture_options_init(vlr_texture_options* options) {
  *options = {};
  options->struct_size = sizeof(vlr_texture_options);
  options->filter = VLR_FILTER_LINEAR;
  options->channel = -1;
  for (const int i : {0, 4, 8}) options->colors[i] = 1.0f;
}

vlr_status vlr_texture_create(uint32_t width, uint32_t height, uint32_t channels, const float* pixels,
                              const vlr_texture_options* options, vlr_texture** out) {
  return guard([&] {
    require(pixels, "pixels");
    require(out, "out");
    constexpr uint32_t kLargest = 65536, kMaxChannels = 64;
    if (width == 0 || height == 0 || channels == 0 || width > kLargest || height > kLargest ||
        channels > kMaxChannels) {
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
    static_assert(VLR_MOST_COLOR_SETS == SurfaceSite::kMaxColorSets);
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

#include <algorithm>
#include <cmath>

#include "capi/conversions.h"
#include "material/bsdf_materials.h"
#include "material/derived_materials.h"
#include "material/normal_map.h"
#include "material/program/program.h"
#include "scene/world_program.h"

using namespace velour;
using namespace velour::capi;

namespace {

static_assert(VLR_OPERATION_MAP_RANGE_VECTOR + 1 == kOperations);
static_assert(VLR_SOURCE_SHADOW_RAY + 1 == kSources);
static_assert(VLR_MATH_DEGREES == static_cast<int>(MathOperation::degrees));
static_assert(VLR_VECTOR_ROUND == static_cast<int>(VectorOperation::round));
static_assert(VLR_BLEND_VALUE == static_cast<int>(BlendMode::value));
static_assert(VLR_NOISE_HETERO_TERRAIN == static_cast<int>(NoiseKind::hetero_terrain));
static_assert(VLR_VORONOI_N_SPHERE_RADIUS == static_cast<int>(VoronoiFeature::n_sphere_radius));
static_assert(VLR_GRADIENT_RADIAL == static_cast<int>(GradientKind::radial));

template <class T>
std::vector<T> copied(const T* values, uint32_t count, const char* field) {
  if (count > 0) require(values, field);
  return std::vector<T>(values, values + count);
}

Instruction converted(const vlr_instruction& given) {
  Instruction at;
  at.operation = static_cast<Operation>(given.operation);
  std::copy(std::begin(given.choice), std::end(given.choice), at.choice.begin());
  std::copy(std::begin(given.input), std::end(given.input), at.input.begin());
  at.output = given.output;
  at.table = given.table;
  at.table_size = given.table_size;
  return at;
}

ProgramImage converted(const vlr_texture* texture, size_t index) {
  if (texture == nullptr || (!texture->color && !texture->number)) {
    refuse("vlr_program_desc.images[" + std::to_string(index) + "] is not a texture of pixels.");
  }
  return {texture->color, texture->number};
}

ProgramOutput converted(const vlr_program_output& output) {
  require_choice(output.kind, VLR_VALUE_NORMAL, "vlr_program_output.kind");
  return {output.first, output.kind == VLR_VALUE_NUMBER, output.kind == VLR_VALUE_NORMAL};
}

void require_count(uint32_t count, size_t most, const char* field) {
  if (count <= most) return;
  refuse(std::string(field) + " is " + std::to_string(count) + "; at most " + std::to_string(most) + " are supported.");
}

ProgramDescription converted(const vlr_program_desc& desc) {
  require_count(desc.constant_count, Program::kMaxRegisters, "vlr_program_desc.constant_count");
  require_count(desc.instruction_count, Program::kMaxInstructions, "vlr_program_desc.instruction_count");
  require_count(desc.table_count, Program::kMaxTableValues, "vlr_program_desc.table_count");
  require_count(desc.image_count, Program::kMaxImages, "vlr_program_desc.image_count");
  require_count(desc.output_count, Program::kMaxOutputs, "vlr_program_desc.output_count");
  ProgramDescription given;
  if (!(desc.step > 0.0f) || !std::isfinite(desc.step)) refuse("vlr_program_desc.step must be a positive number.");
  given.registers = desc.registers;
  given.step = desc.step;
  given.constants = copied(desc.constants, desc.constant_count, "vlr_program_desc.constants");
  given.tables = copied(desc.tables, desc.table_count, "vlr_program_desc.tables");
  if (desc.instruction_count > 0) require(desc.instructions, "vlr_program_desc.instructions");
  for (uint32_t i = 0; i < desc.instruction_count; ++i) given.instructions.push_back(converted(desc.instructions[i]));
  if (desc.image_count > 0) require(desc.images, "vlr_program_desc.images");
  for (uint32_t i = 0; i < desc.image_count; ++i) given.images.push_back(converted(desc.images[i], i));
  if (desc.output_count > 0) require(desc.outputs, "vlr_program_desc.outputs");
  for (uint32_t i = 0; i < desc.output_count; ++i) given.outputs.push_back(converted(desc.outputs[i]));
  return given;
}

}  // namespace

void vlr_program_desc_init(vlr_program_desc* desc) {
  *desc = {};
  desc->struct_size = sizeof(vlr_program_desc);
  desc->step = 1.0f;
}

vlr_status vlr_program_create(const vlr_program_desc* desc, vlr_program** out) {
  return guard([&] {
    require(out, "out");
    const auto given = read_options(desc, vlr_program_desc_init, "vlr_program_desc");
    *out = new vlr_program{std::make_shared<const Program>(converted(given))};
  });
}

void vlr_program_free(vlr_program* program) { delete program; }

vlr_status vlr_program_radiance(const vlr_program* program, uint32_t output, int32_t rays, uint32_t count,
                                const float* directions, float* radiance) {
  return guard([&] {
    require(program, "program");
    require(directions, "directions");
    require(radiance, "radiance");
    require_choice(rays, VLR_WORLD_RAYS_SHADOW, "rays");
    const WorldProgram world(program->program, output);
    DirectionBatch batch;
    RgbBatch found;
    for (uint32_t begin = 0; begin < count; begin += DirectionBatch::kCapacity) {
      batch.count = 0;
      for (uint32_t i = begin; i < std::min(count, begin + DirectionBatch::kCapacity); ++i) {
        const float* d = directions + 3 * size_t{i};
        batch.push({d[0], d[1], d[2]});
      }
      world.look_up(batch, static_cast<WorldRays>(rays), found);
      for (int i = 0; i < batch.count; ++i) {
        const Rgb color = found.get(i);
        std::copy_n(&color.x, 3, radiance + 3 * (size_t{begin} + static_cast<size_t>(i)));
      }
    }
  });
}

vlr_status vlr_texture_of_program(const vlr_program* program, uint32_t output, vlr_texture** out) {
  return guard([&] {
    require(program, "program");
    require(out, "out");
    const size_t count = program->program->outputs().size();
    if (output >= count) {
      refuse("The program has no output " + std::to_string(output) + "; it has " + std::to_string(count) +
             " outputs, counted from 0.");
    }
    auto texture = std::make_unique<vlr_texture>();
    texture->program = program->program;
    texture->output = output;
    *out = texture.release();
  });
}

namespace {

Rgb base_color(const vlr_principled_desc& d) { return {d.base_color[0], d.base_color[1], d.base_color[2]}; }

/// A normal map of a layer or of its coat.
struct LayerNormal {
  const vlr_texture* texture;
  const float* map;
  uint32_t set;
  float strength;
  int32_t correction;
  const char* field;

  TextureSlot<Rgb> slot() const { return color_slot(texture, map, set, field); }
  std::optional<NormalMap> converted() const {
    if (texture == nullptr) return std::nullopt;
    return NormalMap{slot(), std::max(strength, 0.0f), static_cast<ReliefCorrection>(correction)};
  }
  /// Needs tangents.
  bool is_map() const { return texture != nullptr && !texture->program; }
  /// Throws Error(invalid_argument) if it is an output of a program that is not a normal.
  void require_normal() const {
    if (texture == nullptr || !texture->program || texture->program->outputs()[texture->output].is_normal) return;
    refuse(field + std::string(" is output ") + std::to_string(texture->output) +
           " of a program, which is not a normal (VLR_VALUE_NORMAL).");
  }
};

template <typename Layer>
LayerNormal normal_of(const Layer& layer, const char* field) {
  return {layer.normal, layer.normal_map, layer.normal_set, layer.normal_strength, layer.normal_correction, field};
}
LayerNormal normal_of(const vlr_layer_desc& layer) { return normal_of(layer, "vlr_layer_desc.normal"); }
LayerNormal normal_of(const vlr_measured_layer_desc& layer) {
  return normal_of(layer, "vlr_measured_layer_desc.normal");
}
LayerNormal coat_normal_of(const vlr_layer_desc& layer) {
  return {layer.coat_normal,          layer.coat_normal_map,   layer.coat_normal_set,
          layer.coat_normal_strength, layer.normal_correction, "vlr_layer_desc.coat_normal"};
}

/// None: interpolated normals are not corrected.
std::optional<ReliefCorrection> correction_of(const vlr_principled_desc& desc) {
  require_choice(desc.surface_correction, VLR_RELIEF_AS_IT_IS, "vlr_principled_desc.surface_correction");
  if (desc.surface_correction == VLR_RELIEF_AS_IT_IS) return std::nullopt;
  return static_cast<ReliefCorrection>(desc.surface_correction);
}

/// Normals of a layer and of its coat; none: the surface's.
struct Normals {
  std::optional<NormalMap> own{}, coat{};
};

std::shared_ptr<const Material> with_normals(std::shared_ptr<const Material> material,
                                             const std::optional<NormalMap>& normal, ReliefPart part) {
  return normal ? make_normal_mapped(std::move(material), *normal, part) : material;
}

/// Steep normals affect base and lobes differently, so each is a layer of its own, as is the coat, which has its own
/// normal. Disney's clear coat dims nothing.
std::shared_ptr<const Material> principled(PrincipledParameters parameters, PrincipledTextures textures,
                                           const Normals& normals) {
  textures.alpha = {};
  if (!normals.own && !normals.coat) return make_principled_material(parameters, textures);
  ShaderLayers parts;
  const auto part = [&](PrincipledPart which) {
    parameters.part = which;
    return make_principled_material(parameters, textures);
  };
  const PrincipledTop top{parameters, textures, normals.own, normals.coat};
  const PrincipledParameters anywhere = textures.anywhere(parameters);
  const bool is_layered = parameters.formula == PrincipledFormula::layered;
  if (anywhere.coat > 0) {
    parts.reflecting.push_back({.material = with_normals(part(PrincipledPart::coat), normals.coat, ReliefPart::lobe),
                                .lifts_views = !normals.coat});
  }
  parameters.coat = 0;
  textures.remove(&PrincipledParameters::coat);
  const auto add_below = [&](PrincipledPart which, ReliefPart relief, std::optional<PrincipledTop> dimmed_by) {
    parts.reflecting.push_back({.material = with_normals(part(which), normals.own, relief),
                                .top = std::move(dimmed_by),
                                .lifts_views = !normals.own});
  };
  if (is_layered && anywhere.sheen > 0) {
    add_below(PrincipledPart::sheen, ReliefPart::lobe, std::nullopt);
    parameters.sheen = 0;
    textures.remove(&PrincipledParameters::sheen);
  }
  if (anywhere.transmission > 0) add_below(PrincipledPart::glass, ReliefPart::lobe, top);
  add_below(PrincipledPart::base, ReliefPart::base, top);
  add_below(PrincipledPart::specular, ReliefPart::lobe, top);
  return make_layered_material(std::move(parts));
}

std::shared_ptr<const Material> reflecting(const vlr_layer_desc& layer, const vlr_principled_desc& desc,
                                           const PrincipledTextures& textures, const Normals& normals) {
  if (layer.kind == VLR_LAYER_GLOSSY) {
    const GlossyParameters glossy{base_color(desc), desc.roughness, lobe_of(desc), textures.base_color,
                                  textures.roughness};
    return with_normals(make_glossy_material(glossy), normals.own, ReliefPart::lobe);
  }
  if (layer.kind == VLR_LAYER_TRANSLUCENT) {
    return with_normals(make_translucent_material(base_color(desc), textures.base_color), normals.own,
                        ReliefPart::diffuse);
  }
  if (layer.kind == VLR_LAYER_GLASS || layer.kind == VLR_LAYER_REFRACTION) {
    const PrincipledParameters checked = parameters_of(desc);
    const GlassParameters glass{.reflected = checked.base_color,
                                .refracted = checked.base_color,
                                .roughness = checked.roughness,
                                .refraction_roughness = checked.roughness,
                                .index = checked.index,
                                .only_refracts = layer.kind == VLR_LAYER_REFRACTION,
                                .fresnel = static_cast<GlassFresnel>(desc.glass_fresnel),
                                .lobe = checked.lobe};
    return with_normals(make_glass_material(glass, {textures.base_color, textures.roughness}), normals.own,
                        ReliefPart::lobe);
  }
  if (layer.kind == VLR_LAYER_DIFFUSE) {
    const RoughDiffuseParameters diffuse{base_color(desc), desc.roughness, layer.interreflection != 0,
                                         textures.base_color, textures.roughness};
    return with_normals(make_rough_diffuse_material(diffuse), normals.own, ReliefPart::diffuse);
  }
  return principled(parameters_of(desc), textures, normals);
}

PrincipledTextures textures_of(const vlr_layer_desc& layer) {
  return converted_textures(read_options(layer.textures, vlr_principled_textures_init, "vlr_principled_textures"));
}

Rgb finite_color(const float* color, const char* field) {
  const Rgb given(color[0], color[1], color[2]);
  if (std::isfinite(given.r + given.g + given.b)) return given;
  throw Error(Status::invalid_argument, std::string(field) + " is not finite.");
}

LayerWeight& add_layer(vlr_shader& shader, const vlr_layer_desc& layer) {
  ShaderLayers& layers = shader.layers;
  const auto desc = read_options(layer.surface, vlr_principled_desc_init, "vlr_principled_desc");
  const PrincipledTextures textures = textures_of(layer);
  shader.sets.add(sets_of(textures));
  shader.sets.add(normal_of(layer).slot());
  shader.sets.add(coat_normal_of(layer).slot());
  if (layer.kind == VLR_LAYER_TRANSPARENT) shader.opacity.add(textures.base_color);
  if (layer.kind == VLR_LAYER_TRANSPARENT || layer.kind == VLR_LAYER_EMISSION) {
    auto& to = layer.kind == VLR_LAYER_EMISSION ? layers.emissive : layers.transparent;
    to.push_back({base_color(desc), textures.base_color});
    return to.back().weight;
  }
  const Normals given{normal_of(layer).converted(), coat_normal_of(layer).converted()};
  layers.reflecting.push_back(
      {.material = reflecting(layer, desc, textures, given), .lifts_views = !given.own && !given.coat});
  shader.turned.push_back(nullptr);
  if (const auto correction = correction_of(desc); correction && !given.own) {
    const NormalMap corrected = surface_normal(*correction);
    shader.turned.back() = reflecting(layer, desc, textures, {corrected, given.coat.value_or(corrected)});
  }
  return layers.reflecting.back().weight;
}

SurfaceMaterial measured_surface(const vlr_measured_layer_desc& layer) {
  const int given = (layer.measurement != nullptr) + (layer.btf != nullptr);
  if (given > 1 || (given == 0 && layer.model == nullptr) || (layer.btf != nullptr && layer.model != nullptr)) {
    throw Error(Status::invalid_argument,
                "A measured layer needs one of vlr_measured_layer_desc.model, .measurement (with or without a model to "
                "sample from) and .btf.");
  }
  if (layer.btf != nullptr) return surface_of(*kept(layer.btf->btf), layer.most_bytes);
  auto model = layer.model != nullptr ? kept(layer.model->model) : nullptr;
  if (layer.measurement != nullptr) {
    return surface_of(kept(layer.measurement->measurement), std::move(model), layer.neighbors);
  }
  return surface_of(model, layer.neighbors);
}

Placing placing_of(const vlr_measured_layer_desc& layer) {
  const Placing placing{
      map_from(layer.map),
      number_slot(layer.rotation, layer.rotation_map, layer.rotation_set, "vlr_measured_layer_desc.rotation"),
      number_slot(layer.scale, layer.scale_map, layer.scale_set, "vlr_measured_layer_desc.scale"), layer.aspect};
  if (!placing.map.invertible()) {
    throw Error(Status::invalid_argument,
                "vlr_measured_layer_desc.map contains a number that is not finite, or scales the texture to zero.");
  }
  if (!(placing.aspect > 0.0f) || !std::isfinite(placing.aspect)) {
    throw Error(Status::invalid_argument, "vlr_measured_layer_desc.aspect must be a positive number.");
  }
  return placing;
}

/// Rays meet a silhouette before they meet any layer, so it belongs to the surface.
void add_silhouette(vlr_shader& shader, const SurfaceMaterial& measured, const Placing& placing) {
  if (shader.shell) {
    throw Error(Status::unsupported,
                "A material can have only one silhouette (VOTF), but two of the mixed models have one. Remove the VOTF "
                "of one model.");
  }
  if (placing.map.map != Mat2(1.0f) || placing.map.shift != Vec2(0.0f) || placing.varies()) {
    throw Error(Status::unsupported,
                "vlr_measured_layer_desc.map, .rotation or .scale moves a model with a silhouette (VOTF), which lies "
                "on the surface's own texture coordinates. Place the instance's texture instead.");
  }
  shader.shell = measured.shell;
  shader.shell_shaded = measured.shell_shaded;
}

LayerWeight& add_measured(vlr_shader& shader, const vlr_measured_layer_desc& layer) {
  const Placing placing = placing_of(layer);
  SurfaceMaterial measured = measured_surface(layer);
  if (measured.shell) add_silhouette(shader, measured, placing);
  shader.brushed |= measured.brushed;
  shader.relief |= normal_of(layer).is_map();
  for (const TextureSlot<float>& slot : {placing.rotation, placing.scale}) shader.sets.add(slot);
  shader.sets.add(normal_of(layer).slot());
  const std::optional<NormalMap> normal = normal_of(layer).converted();
  auto material = with_normals(make_placed(std::move(measured.material), placing), normal, ReliefPart::lobe);
  shader.turned.push_back(nullptr);
  shader.layers.reflecting.push_back({.material = std::move(material), .rec709_colors = true, .lifts_views = !normal});
  return shader.layers.reflecting.back().weight;
}

}  // namespace

void vlr_layer_desc_init(vlr_layer_desc* desc) {
  *desc = {};
  desc->struct_size = sizeof(vlr_layer_desc);
  desc->normal_map[0] = desc->normal_map[4] = desc->normal_strength = 1.0f;
  desc->coat_normal_map[0] = desc->coat_normal_map[4] = desc->coat_normal_strength = 1.0f;
}

void vlr_measured_layer_desc_init(vlr_measured_layer_desc* desc) {
  *desc = {};
  desc->struct_size = sizeof(vlr_measured_layer_desc);
  for (float* map : {desc->map, desc->normal_map, desc->rotation_map, desc->scale_map}) map[0] = map[4] = 1.0f;
  desc->normal_strength = desc->aspect = 1.0f;
}

void vlr_factor_desc_init(vlr_factor_desc* desc) {
  *desc = {};
  desc->struct_size = sizeof(vlr_factor_desc);
  desc->value = desc->map[0] = desc->map[4] = 1.0f;
  desc->color[0] = desc->color[1] = desc->color[2] = 1.0f;
}

vlr_status vlr_shader_create(vlr_shader** out) {
  return guard([&] {
    require(out, "out");
    *out = new vlr_shader;
  });
}

void vlr_shader_free(vlr_shader* shader) { delete shader; }

std::shared_ptr<const Material> velour::capi::turned_material(const vlr_principled_desc& desc,
                                                              const PrincipledTextures& textures) {
  const auto correction = correction_of(desc);
  if (!correction) return nullptr;
  return principled(parameters_of(desc), textures, {surface_normal(*correction), surface_normal(*correction)});
}

vlr_status vlr_shader_add_layer(vlr_shader* shader, const vlr_layer_desc* desc) {
  return guard([&] {
    require(shader, "shader");
    const auto layer = read_options(desc, vlr_layer_desc_init, "vlr_layer_desc");
    require_choice(layer.kind, VLR_LAYER_TRANSLUCENT, "vlr_layer_desc.kind");
    require_choice(layer.normal_correction, VLR_RELIEF_AS_IT_IS, "vlr_layer_desc.normal_correction");
    for (const LayerNormal& normal : {normal_of(layer), coat_normal_of(layer)}) {
      normal.require_normal();
      shader->relief |= normal.is_map();
    }
    shader->last = &add_layer(*shader, layer);
  });
}

vlr_status vlr_shader_add_measured_layer(vlr_shader* shader, const vlr_measured_layer_desc* desc) {
  return guard([&] {
    require(shader, "shader");
    const auto layer = read_options(desc, vlr_measured_layer_desc_init, "vlr_measured_layer_desc");
    require_choice(layer.normal_correction, VLR_RELIEF_AS_IT_IS, "vlr_measured_layer_desc.normal_correction");
    normal_of(layer).require_normal();
    shader->last = &add_measured(*shader, layer);
  });
}

vlr_status vlr_shader_weigh_layer(vlr_shader* shader, const vlr_factor_desc* desc) {
  return guard([&] {
    require(shader, "shader");
    const auto factor = read_options(desc, vlr_factor_desc_init, "vlr_factor_desc");
    require_choice(factor.kind, VLR_FACTOR_LEVEL, "vlr_factor_desc.kind");
    if (!std::isfinite(factor.value)) throw Error(Status::invalid_argument, "vlr_factor_desc.value is not finite.");
    if (shader->last == nullptr) {
      throw Error(Status::invalid_state,
                  "The shader has no layer that the factor could weight; add a layer before its factors.");
    }
    if (factor.kind == VLR_FACTOR_TINT) {
      const auto colors = color_slot(factor.texture, factor.map, factor.set, "vlr_factor_desc.texture");
      shader->last->tints.push_back({finite_color(factor.color, "vlr_factor_desc.color"), colors});
      shader->sets.add(colors);
      shader->opacity.add(colors);
      return;
    }
    const auto texture = number_slot(factor.texture, factor.map, factor.set, "vlr_factor_desc.texture");
    const LayerLevel level{factor.level[0], factor.level[1], factor.level[2]};
    if (!(level.begin <= level.peak && level.peak <= level.end) || !std::isfinite(level.end - level.begin)) {
      throw Error(Status::invalid_argument, "vlr_factor_desc.level must be three finite numbers in ascending order.");
    }
    shader->sets.add(texture);
    shader->opacity.add(texture);
    shader->last->factors.push_back({static_cast<LayerFactor::Kind>(factor.kind), factor.value, texture, level});
  });
}

vlr_status vlr_scene_add_shader_material(vlr_scene* scene, const vlr_shader* shader, uint32_t* material) {
  return guard([&] {
    require(scene, "scene");
    require(shader, "shader");
    require(material, "material");
    ShaderLayers layers = shader->layers;
    layers.rec709_to_working = scene->scene->rec709_to_working();
    std::shared_ptr<const Material> turned;
    if (std::ranges::any_of(shader->turned, [](const auto& each) { return each != nullptr; })) {
      ShaderLayers other = layers;
      for (size_t i = 0; i < other.reflecting.size(); ++i) {
        if (!shader->turned[i]) continue;
        other.reflecting[i].material = shader->turned[i];
        other.reflecting[i].lifts_views = false;
      }
      turned = make_layered_material(std::move(other));
    }
    SurfaceMaterial surface{.material = make_layered_material(std::move(layers)),
                            .rec709_colors = false,
                            .relief = shader->relief,
                            .brushed = shader->brushed,
                            .shell = shader->shell,
                            .shell_shaded = shader->shell_shaded,
                            .turned = std::move(turned)};
    use_sets(surface, shader->sets, shader->opacity.outputs);
    *material = scene->scene->add_material(std::move(surface));
  });
}

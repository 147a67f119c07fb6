// Conversion of colors, matrices, options and measured materials from the caller's form.
#pragma once

#include <algorithm>
#include <string>
#include <vector>
#include "base/error.h"
#include "capi/guard.h"
#include "capi/handles.h"
#include "image/picture.h"
#include "material/principled/principled_material.h"
#include "material/texture.h"
#include "math/sphere/affine.h"
#include "math/sphere/vec.h"
#include "scene/scene.h"
#include "velour/velour.h"

namespace velour::capi {

inline constexpr uint32_t kContinuedRays = VLR_HIDDEN_FROM_BOUNCES | VLR_HIDDEN_FROM_TRANSMISSION;
inline constexpr uint32_t kRays = VLR_HIDDEN_FROM_CAMERA | VLR_HIDDEN_FROM_SHADOWS | kContinuedRays;

/// Throws Error(invalid_argument) for bits outside `known`.
inline void require_hidden(uint32_t hidden_from, uint32_t known) {
  if ((hidden_from & ~known) == 0) return;
  throw Error(Status::invalid_argument, "hidden_from is " + std::to_string(hidden_from) +
                                            ", which has bits that do not apply here; those that do have the sum " +
                                            std::to_string(known) + ".");
}

inline Rgb color_from(const float* c) { return {c[0], c[1], c[2]}; }

/// Null: the identity.
inline Mat3 matrix_from_rows(const float* m) {
  if (!m) return Mat3(1.0f);
  return {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
}

/// `m` [3 x 4, row-major].
inline Affine affine_from(const float* m) {
  Affine map;
  std::copy(m, m + 12, map.m);
  return map;
}

/// `m` [count x 3 x 4, row-major].
inline std::vector<Affine> affines_from(const float* m, size_t count) {
  std::vector<Affine> maps;
  for (size_t i = 0; i < count; ++i) maps.push_back(affine_from(m + 12 * i));
  return maps;
}

/// `given` NULL: the defaults.
inline PictureOptions converted(const vlr_picture_options* given) {
  const auto options = read_options(given, vlr_picture_options_init, "vlr_picture_options");
  require_choice(options.as_stored, 1, "vlr_picture_options.as_stored");
  return {.layer = options.layer ? options.layer : "", .as_stored = options.as_stored != 0};
}

// Conversion of Principled parameters and their textures.

/// These throw Error(invalid_argument), which names `field`, for a texture of the wrong kind and for a set of texture
/// coordinates beyond the last.
TextureSlot<Rgb> color_slot(const vlr_texture* texture, const float* map, uint32_t set, const char* field);
TextureSlot<float> number_slot(const vlr_texture* texture, const float* map, uint32_t set, const char* field);
PrincipledTextures converted_textures(const vlr_principled_textures& textures);
MeshSets sets_of(const PrincipledTextures& textures);
/// Sets of a mesh and program of a material. `opacity_outputs`: outputs of the program that opacity depends on, as
/// bits.
void use_sets(SurfaceMaterial& surface, const MeshSets& sets, uint32_t opacity_outputs);

/// These throw Error(invalid_argument) for values outside their enums.
GgxLobe lobe_of(const vlr_principled_desc& desc);
PrincipledParameters parameters_of(const vlr_principled_desc& desc);
std::shared_ptr<const Material> material_of(const vlr_principled_desc& desc, const PrincipledTextures& textures);
/// SurfaceMaterial::turned of that material; null if its interpolated normals are not corrected.
std::shared_ptr<const Material> turned_material(const vlr_principled_desc& desc, const PrincipledTextures& textures);

// Conversion of texture coordinate maps.

/// `m` [2 x 3, row-major] is applied to (u, v, 1).
inline TextureMap map_from(const float* m) { return {{m[0], m[3], m[1], m[4]}, {m[2], m[5]}}; }

// Materials of models, raw measurements and BTFs, as surfaces and as layers of shaders.

/// `neighbors`: see make_material().
SurfaceMaterial surface_of(const std::shared_ptr<const Model>& model, uint32_t neighbors);
/// f of the measurement; null `proposal`: samples come from a coarse model made here.
SurfaceMaterial surface_of(std::shared_ptr<const Measurement> measurement, std::shared_ptr<const Model> proposal,
                           uint32_t neighbors);
/// The BTF itself, with transmitted light if it has some. `most_bytes` 0: the default limit of read_btf_table().
SurfaceMaterial surface_of(const BtfMeasurement& btf, uint64_t most_bytes);

}  // namespace velour::capi

// Conversion of Principled parameters and their textures.
#pragma once

#include "capi/guard.h"
#include "capi/handles.h"
#include "material/principled_material.h"

namespace velour::capi {

/// These throw Error(invalid_argument), which names `field`, for a texture of the wrong kind and for a set of texture
/// coordinates beyond the last.
TextureSlot<Rgb> color_slot(const vlr_texture* texture, const float* map, uint32_t set, const char* field);
TextureSlot<float> number_slot(const vlr_texture* texture, const float* map, uint32_t set, const char* field);
PrincipledTextures converted_textures(const vlr_principled_textures& textures);
MeshSets sets_of(const PrincipledTextures& textures);

/// These throw Error(invalid_argument) for values outside their enums.
GgxLobe lobe_of(const vlr_principled_desc& desc);
PrincipledParameters parameters_of(const vlr_principled_desc& desc);
std::shared_ptr<const Material> material_of(const vlr_principled_desc& desc, const PrincipledTextures& textures);

}  // namespace velour::capi

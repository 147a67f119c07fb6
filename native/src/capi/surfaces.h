// Principled parameters and their pictures as callers give them.
#pragma once

#include "capi/guard.h"
#include "capi/handles.h"
#include "material/principled_material.h"

namespace velour::capi {

/// These throw Error(invalid_argument), by the name of `field`, for a texture of the other kind and for a set of
/// texture coordinates beyond the last.
TextureSlot<Rgb> color_slot(const vlr_texture* texture, const float* map, uint32_t set, const char* field);
TextureSlot<float> number_slot(const vlr_texture* texture, const float* map, uint32_t set, const char* field);
PrincipledTextures converted_textures(const vlr_principled_textures& textures);
MeshSets sets_of(const PrincipledTextures& textures);

/// These throw Error(invalid_argument) for choices that there are not.
GgxLobe lobe_of(const vlr_principled_desc& desc);
PrincipledParameters parameters_of(const vlr_principled_desc& desc);
std::shared_ptr<const Material> material_of(const vlr_principled_desc& desc, const PrincipledTextures& textures);

}  // namespace velour::capi

// A BTF's model, reduced to what scenes show of it.
#pragma once

#include "compress/compress_btf.h"

namespace velour {

/// options.full_model, or the model that the other options ask for, without the levels that no ray of options.for_scene
/// resolves (scene_levels.h). It carries a SceneRecord; a camera that comes closer is told by domain/out_of_domain.h.
/// Where the scene needs every level the full model is returned, with a warning. `psnr`, `ser` and speed are those of
/// the full model.
///
/// Throws Error(invalid_argument) when nothing of a surface was observed, or the full model is not one of this BTF, or
/// is itself reduced.
Model compress_for_scene(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress);

}  // namespace velour

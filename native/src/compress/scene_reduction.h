// A BTF's model, reduced to its scene usage.
#pragma once

#include "compress/compress_btf.h"

namespace velour {

/// Reduces options.full_model, or the model that the other options ask for, to a smaller one of the same method:
/// refitted to the scene usage options.for_scene (scene_refit.h) or, if that is no better, without the levels that no
/// ray resolves (scene_levels.h). The result carries a SceneRecord; domain/out_of_domain.h reports a camera that comes
/// closer or sees other views. If the scene needs every level, returns the full model with a warning. `psnr`, `ser` and
/// speed are those of the full model.
///
/// Throws Error(invalid_argument) if nothing of a surface was observed, or if the full model is not one of this BTF or
/// is itself reduced.
Model compress_for_scene(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress);

}  // namespace velour

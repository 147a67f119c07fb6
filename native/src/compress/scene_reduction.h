// A BTF's model, reduced to what scenes show of it.
#pragma once

#include "compress/compress_btf.h"

namespace velour {

/// In place of options.full_model, or of the model that the other options ask for: a smaller one of the same method,
/// fitted anew to what options.for_scene shows (scene_refit.h), or where that does no better without the levels that no
/// ray resolves (scene_levels.h). It carries a SceneRecord; a camera that comes closer, or sees other views, is told by
/// domain/out_of_domain.h. Where the scene needs every level the full model is returned, with a warning. `psnr`, `ser`
/// and speed are those of the full model.
///
/// Throws Error(invalid_argument) when nothing of a surface was observed, or the full model is not one of this BTF, or
/// is itself reduced.
Model compress_for_scene(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress);

}  // namespace velour

// A BTF's model, reduced to its scene usage.
#pragma once

#include <cstddef>
#include <functional>
#include "btf/fit/btf_fit.h"

namespace velour {

/// Reduces options.full_model, or the model that the other options ask for, to a smaller one of the same method:
/// refitted to the scene usage options.for_scene (scene_refit.h) or, if that is no better, without the levels that no
/// ray resolves (scene_btf.h). The result carries a SceneRecord; usage/observation.h reports a camera that comes
/// closer or sees other views. If the scene needs every level, returns the full model with a warning. `psnr`, `ser` and
/// speed are those of the full model.
///
/// Throws Error(invalid_argument) if nothing of a surface was observed, or if the full model is not one of this BTF or
/// is itself reduced.
Model compress_for_scene(const BtfMeasurement& measurement, const CompressOptions& options, Progress& progress);

// Search for the smallest sufficient size with few trials.

/// Sizes are numbered from 0. Doubles the size from the smallest until one is good, then searches between it and the
/// previous one, to within a fifth. The candidate sizes do not depend on `good`, and larger sizes are not assumed to be
/// better: a search that accepts every size that another one accepts never returns a larger size.
///
/// `good`: whether a size is sufficient. Returns a good size, or `end` if none is found below it.
size_t least_size(size_t end, const std::function<bool(size_t)>& good);

}  // namespace velour

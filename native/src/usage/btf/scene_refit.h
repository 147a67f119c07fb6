// Refit of a BTF's model to its scene usage, as small as the images allow.
#pragma once

#include <optional>

#include "btf/fit/btf_fit.h"

namespace velour {

struct SceneRefit {
  ModelBody body;                    // its layout has the views to which it was fitted
  double error = 0, full_error = 0;  // SeenPictures::error
};

/// `levels` is `full` without the levels that the scenes do not resolve (scene_btf.h). Fits the BTF at the
/// resolution of `levels`, reduced to the views seen and those around them (scene_btf.h). Takes the smallest size tried
/// by scene_reduction.h, between a 64th of the bytes of `full` and those of `levels`, whose image error is within
/// kMoreError of that of `full`; if there is none, the largest size, if its error is below that of `levels`. Otherwise
/// returns nothing; also if the observation has no light or the BTF has entries that are not finite, and for clustered
/// tensors, which only lose levels.
std::optional<SceneRefit> refit_for_scene(const BtfMeasurement& measurement, const ModelBody& full,
                                          const ModelBody& levels, const CompressOptions& options, Progress& progress);

/// Maximum ratio of the relmse to that of the full model.
inline constexpr double kMoreError = 1.1;

}  // namespace velour

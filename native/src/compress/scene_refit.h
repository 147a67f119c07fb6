// A model of a BTF fitted anew to what scenes show of it, as small as their pictures allow.
#pragma once

#include <optional>

#include "compress/compress_btf.h"

namespace velour {

struct SceneRefit {
  ModelBody body;                    // its layout has the views that it was fitted to
  double error = 0, full_error = 0;  // SeenPictures::error
};

/// `levels` is `full` without the levels that the scenes do not resolve (scene_levels.h). The BTF at the resolution of
/// `levels`, of the views seen and those around them (scene_btf.h), is fitted with the least size, of those that
/// least_size.h looks at, with which the error of the pictures stays within kMoreError of that of `full`: between a
/// 64th of the bytes of `full` and those of `levels`. Where none is: with the largest, if it errs less than `levels`.
/// Else nothing; nor where the observation tells no light, or the BTF has entries that are not finite; nor of clustered
/// tensors, whose levels alone are left out.
std::optional<SceneRefit> refit_for_scene(const BtfMeasurement& measurement, const ModelBody& full,
                                          const ModelBody& levels, const CompressOptions& options, Progress& progress);

/// Of relmse.
inline constexpr double kMoreError = 1.1;

}  // namespace velour

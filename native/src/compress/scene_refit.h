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
/// `levels`, of the views seen and those around them (scene_btf.h), is fitted with an eighth of the bytes of `full`;
/// with a half of that and so on while the error of the pictures stays within kMoreError of that of `full`; with a
/// quarter where an eighth is too little. Where a quarter is, too: the eighth, if it errs less than `levels`. Else
/// nothing; nor where the observation tells no light, the BTF has entries that are not finite, or the BTF has two
/// sides, since an observation does not say which it saw; nor of clustered tensors, whose levels alone are left out.
std::optional<SceneRefit> refit_for_scene(const BtfMeasurement& measurement, const ModelBody& full,
                                          const ModelBody& levels, const CompressOptions& options, Progress& progress);

/// Of relmse.
inline constexpr double kMoreError = 1.1;

}  // namespace velour

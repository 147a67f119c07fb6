// Shapes and clusters of tensors in a fit's checkpoint, checked as they are read.
#pragma once

#include "btf/tensor_btf.h"
#include "compress/fit_checkpoint.h"
#include "compress/shape_search.h"
#include "compress/side_views.h"

namespace velour {

std::optional<FoundShape> kept_shape(const FitCheckpoint& checkpoint, const std::string& stage);
void keep_shape(FitCheckpoint& checkpoint, const std::string& stage, const FoundShape& found);

/// Puts what was kept into the clusters of `side`, whose number and ranks are set; false where not all were.
bool take_kept_clusters(const FitCheckpoint& checkpoint, const std::string& stage, const SideDirections& directions,
                        TensorSide& side);
void keep_clusters(FitCheckpoint& checkpoint, const std::string& stage, const TensorSide& side);

}  // namespace velour

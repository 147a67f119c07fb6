// Shapes, clusters and texels of tensors in a fit's checkpoint, validated when read.
#pragma once

#include "btf/fit/fit_checkpoint.h"
#include "btf/fit/seen_texels.h"
#include "btf/fit/side_views.h"
#include "btf/fit/tensor/shape_search.h"
#include "btf/model/tensor_btf.h"

namespace velour {

std::optional<FoundShape> kept_shape(const FitCheckpoint& checkpoint, const std::string& stage);
void keep_shape(FitCheckpoint& checkpoint, const std::string& stage, const FoundShape& found);

/// Restores the clusters of `side`, whose number and ranks are set; returns false if any is missing.
bool take_kept_clusters(const FitCheckpoint& checkpoint, const std::string& stage, const SideDirections& directions,
                        TensorSide& side);
void keep_clusters(FitCheckpoint& checkpoint, const std::string& stage, const TensorSide& side);

/// Solved texels of a level, and TensorTexels::measured().
struct SolvedLevel {
  TensorTexelValues values;
  double measured;
};

std::optional<SolvedLevel> kept_level(const FitCheckpoint& checkpoint, const std::string& stage, const Relief& relief,
                                      const TensorSide& side);
void keep_level(const SolvedLevel& level, const std::string& stage, FitCheckpoint& checkpoint);

}  // namespace velour

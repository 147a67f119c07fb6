// What a BTF's views and lights have in common: bases that its texels are described in before clusters are sought.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compress/shown_texels.h"
#include "compress/side_views.h"
#include "tensor/tensor_view.h"

namespace velour {

/// A side of a BTF whose tensor is sought.
struct TensorSource {
  const TexelGrid& grid;
  const SideDirections& side;
  const std::vector<Relief>& relief;  // of each level, the finest first
  uint64_t seed;
  int threads;
};

struct DirectionBasis {
  RowMatrix vector;        // direction x rank, orthonormal columns, the strongest first
  Eigen::VectorXd energy;  // of each, in the mean over texels
  double rest = 0;         // of a direction, in the mean: what they leave
};

struct DirectionBases {
  DirectionBasis view, light;
};

/// Eigenvectors of the mean products of what random points of the relief show, between any two views and any two
/// lights; `rank` of each at most. Reads every view once, and holds what `points` points show.
DirectionBases direction_bases(CompandedViews& views, const TensorSource& source, Index rank, size_t points,
                               Progress& progress);

/// Numbers of `count` random texels, all different, in random order; of all texels where that is not fewer.
std::vector<uint32_t> random_texels(uint64_t texels, size_t count, uint64_t seed);

}  // namespace velour

// Bases of a BTF's views and lights, in which its texels are described before clustering.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "compress/shown_texels.h"
#include "compress/side_views.h"
#include "tensor/tensor_view.h"

namespace velour {

/// A side of a BTF to be fitted by tensors.
struct TensorSource {
  const TexelGrid& grid;
  const SideDirections& side;
  const std::vector<Relief>& relief;  // per level, finest first
  uint64_t seed;
  int threads;
};

struct DirectionBasis {
  RowMatrix vector;        // direction x rank, orthonormal columns, strongest first
  Eigen::VectorXd energy;  // energy of each vector, averaged over texels
  double rest = 0;         // mean residual energy of a direction
};

struct DirectionBases {
  DirectionBasis view, light;
};

/// Eigenvectors of the mean products between any two views, and between any two lights, of the values of random points
/// of the relief; at most `rank` each. Reads every view once and holds the values of `points` points.
DirectionBases direction_bases(CompandedViews& views, const TensorSource& source, Index rank, size_t points,
                               Progress& progress);

/// Indices of `count` different random texels, in random order; all texels if there are no more.
std::vector<uint32_t> random_texels(uint64_t texels, size_t count, uint64_t seed);

}  // namespace velour

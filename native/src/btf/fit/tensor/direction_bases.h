// Bases of a BTF's views and lights, and its texels in them: the tensor to be clustered.
#pragma once

#include <Eigen/Core>
#include <vector>
#include "base/progress.h"
#include "btf/fit/side_views.h"
#include "btf/measure/relief.h"
#include "image/texels.h"
#include "math/tensor/tensor_view.h"

namespace velour {

// Visibility of a relief's texels in the images of a view.

struct ShownTexel {
  BilinearTexels at;  // in the image
  bool shown;         // false: hidden by the relief
};

/// Where the view shows the relief points at the centers of the given texels (shown_at); on the plane, at the texels.
std::vector<ShownTexel> shown_texels(const Relief& relief, const std::vector<uint32_t>& texels, const Vec3& wv,
                                     float aspect, int threads, const Progress& progress);

/// Interpolates rows of four texels, [texel][any].
inline Eigen::RowVectorXf blended(const RowMatrix& rows, const BilinearTexels& at) {
  if (at.weight[0] == 1.0f) return rows.row(at.index[0]);
  return at.weight[0] * rows.row(at.index[0]) + at.weight[1] * rows.row(at.index[1]) +
         at.weight[2] * rows.row(at.index[2]) + at.weight[3] * rows.row(at.index[3]);
}

/// Whether the relief is the reference plane itself.
inline bool is_plane(const Relief& relief) { return relief.flat() && relief.height_of(0, 0) == 0; }

/// A side of a BTF to be fitted by tensors.
struct TensorSource {
  const TexelGrid& grid;
  const SideDirections& side;
  const std::vector<Relief>& relief;  // per level, finest first
  uint64_t seed;
  int threads;
  uint64_t inverse_bytes = ~uint64_t{0};  // TensorAllowance
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

struct ReducedTexels {
  std::vector<uint32_t> texel;  // on the finest level
  DenseTensor slices;           // [texel][view basis][light basis][axis]
  double relief_share;          // ReliefGap::share()
};

/// Values of `texels` in all views, projected on the bases. Texels hidden from some views are solved for by least
/// squares over the others, with the bases' energies as a prior. Reads every view once.
ReducedTexels reduced_texels(CompandedViews& views, const TensorSource& source, const DirectionBases& bases,
                             std::vector<uint32_t> texels, Progress& progress);

}  // namespace velour

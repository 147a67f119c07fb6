// Visibility of a relief's texels in the images of a view.
#pragma once

#include <vector>

#include "btf/bilinear_texels.h"
#include "btf/relief.h"
#include "job/progress.h"
#include "tensor/row_matrix.h"

namespace velour {

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

}  // namespace velour

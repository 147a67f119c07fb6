// Values of shared lobes at the pairs of a point.
#pragma once

#include "compress/companded_views.h"
#include "compress/surface_points.h"
#include "srbf/multivariate_lobes.h"

namespace velour {

/// Lobes of both frames, ready to be evaluated. Columns of values: the tile's lobes, the texels', without padding.
class LobeValues {
 public:
  LobeValues(std::span<const MultivariateLobe> lobes, uint32_t tile_lobes)
      : tile_(lobes.first(tile_lobes)), texel_(lobes.subspan(tile_lobes)) {}

  /// pair x lobe, of `pairs` pairs of the point at most.
  RowMatrix at(const SurfacePoint& point, size_t pairs) const;

 private:
  MultivariateLobes tile_, texel_;
};

}  // namespace velour

// Values of shared lobes at the pairs of a point.
#pragma once

#include "compress/companded_views.h"
#include "compress/surface_points.h"
#include "srbf/multivariate_lobes.h"

namespace velour {

/// Lobes of both frames. Columns of values: those in the tile's frame, then those in the normal's, without padding.
class LobeValues {
 public:
  LobeValues(std::span<const MultivariateLobe> lobes, uint32_t tile_lobes)
      : tile_(lobes.first(tile_lobes)), texel_(lobes.subspan(tile_lobes)) {}

  /// Values pair x lobe, for at most `pairs` pairs of the point.
  RowMatrix at(const SurfacePoint& point, size_t pairs) const;

 private:
  MultivariateLobes tile_, texel_;
};

}  // namespace velour

// Fit of a BTF by sums of multivariate SRBFs over a relief.
#pragma once

#include "btf/relief.h"
#include "btf/srbf_btf.h"
#include "compress/btf_fitter.h"
#include "compress/colour_axes.h"
#include "compress/fit_memory.h"
#include "compress/shared_lobes.h"
#include "compress/side_shares.h"
#include "compress/side_views.h"

namespace velour {

/// Requirements for all sides of the layout: dark or equal sides are found only by reading them.
FitSize srbf_fit_size(const BtfMeasurement& measurement, const BtfFitOptions& options);

/// Chooses and refines lobes that all texels share by the values of random surface points, then solves for the texels
/// of every level, each starting from the coarser one. The sides of the surface share the bytes by need; transmission
/// has sides of its own if there is any.
class SrbfFitter final : public BtfFitter {
 public:
  /// The arguments must outlive the fitter. Stages in the checkpoint are reused. Throws Error(invalid_argument) if the
  /// bytes do not hold a single coefficient, Error(unsupported) for an incomplete layout or too little memory.
  SrbfFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
             Progress& progress);

  ModelBody fit(size_t point) override;

 private:
  struct Side {
    SideDirections directions;
    std::vector<Relief> relief;
    std::vector<SurfacePoint> points;  // empty while all that is derived from them comes from the checkpoint
  };
  void find_sides(const ColourAxes& colours);
  void find_orders(uint64_t bytes);
  uint32_t search_points(size_t most);
  const std::vector<SurfacePoint>& points_of(size_t side);
  SharedLobes lobes_of(size_t side, size_t coefficients, const std::string& stage);

  const BtfMeasurement& measurement_;
  const BtfFitOptions options_;
  FitCheckpoint& checkpoint_;
  Progress& progress_;
  CompandedViews views_;
  Mat3 axes_{1.0f};
  std::vector<Side> sides_;
  std::vector<SideDemand> demand_;  // per side
  std::vector<SharedSide> shared_;
  std::optional<SideShares> shares_;
};

}  // namespace velour

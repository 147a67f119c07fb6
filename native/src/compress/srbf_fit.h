// A BTF fitted by sums of multivariate SRBFs over a relief.
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

/// Of all sides of the layout: which ones are dark or alike is found by reading them.
FitSize srbf_fit_size(const BtfMeasurement& measurement, const BtfFitOptions& options);

/// Lobes that all texels share are chosen and refined by what random points of the surface show, then the texels of
/// every level are solved for, each level from the coarser one. The sides of the surface share the bytes by need; light
/// that goes through has sides of its own where anything comes through.
class SrbfFitter final : public BtfFitter {
 public:
  /// Both must outlive this. What the checkpoint has kept is not done again. Throws Error(invalid_argument) when the
  /// bytes hold not one coefficient, Error(unsupported) for a layout that is not complete and for too little memory.
  SrbfFitter(const BtfMeasurement& measurement, const BtfFitOptions& options, FitCheckpoint& checkpoint,
             Progress& progress);

  ModelBody fit(size_t point) override;

 private:
  struct Side {
    SideDirections directions;
    std::vector<Relief> relief;
    std::vector<SurfacePoint> points;  // none while all that is made of them was kept
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
  std::vector<SideDemand> demand_;  // of each side
  std::vector<SharedSide> shared_;
  std::optional<SideShares> shares_;
};

}  // namespace velour

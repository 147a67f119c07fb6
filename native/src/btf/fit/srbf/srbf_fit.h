// Fit of a BTF by sums of multivariate SRBFs over a relief.
#pragma once

#include "btf/fit/btf_fitter.h"
#include "btf/fit/fitted_sides.h"
#include "btf/fit/side_views.h"
#include "btf/fit/srbf/lobe_order.h"
#include "btf/measure/relief.h"
#include "btf/model/srbf_btf.h"
#include "model/records.h"

namespace velour {

// Distribution of a BTF's bytes over its sides.

/// Demand of one side.
struct SideDemand {
  LobeOrder order;
  double energy = 0;  // sum of squares of all its companded values, the reference of LobeOrder::left
};

/// Every side gets one coefficient; each further one goes to the side where it reduces the total error most.
class SideShares {
 public:
  /// `texels`: in all levels of a side.
  SideShares(const std::vector<SideDemand>& sides, uint64_t texels);

  /// By coefficients: relative L2 error that the orders leave, bytes, and coefficients of the largest side.
  const OrderCurve& curve() const { return curve_; }
  /// Coefficients of each side at a point of the curve.
  std::vector<size_t> at(size_t point) const;

 private:
  void add_point(const std::vector<SideDemand>& sides, const std::vector<size_t>& count, uint64_t texels);

  size_t sides_;
  std::vector<size_t> next_;  // the side that gets each coefficient after the first of every side
  OrderCurve curve_;
};

/// Stored size of a side of SRBFs: a byte per coefficient and a height for every texel, scales and lobes.
uint64_t srbf_side_bytes(uint64_t texels, size_t coefficients, size_t lobes);

// The lobes shared by all texels of a BTF.

/// Lobes in the tile's frame, then lobes in the frame of the relief's normal, and the lobes that each color axis uses.
struct SharedLobes {
  std::vector<MultivariateLobe> lobes;
  uint32_t tile_lobes = 0;
  std::array<std::vector<uint16_t>, 3> lobe;  // axis 0: all, in order
};

/// The unrefined lobes of the first `coefficients` coefficients of an order, whose candidates were made from `seed`.
SharedLobes chosen_lobes(const LobeOrder& order, size_t coefficients, uint64_t seed);

struct LobeRefinement {
  int steps = 0;  // steps of the descent
  int threads = 0;
};

/// Refines the lobes together by descent of the error that remains when every point has its best coefficients (variable
/// projection [GP73]). The weaker color axes then choose again, as many as in `share`, among the refined lobes.
void refine_lobes(const std::vector<SurfacePoint>& points, const std::array<size_t, 3>& share,
                  const LobeRefinement& options, SharedLobes& lobes, Progress& progress);

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
  void find_sides(const ColorAxes& colors);
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

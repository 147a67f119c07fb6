// Samples a measurement at the slices that are fitted.
#pragma once

#include <memory>
#include <vector>

#include "base/progress.h"
#include "brdf/fit/direction_tree.h"
#include "brdf/fit/slice_samples.h"
#include "brdf/measure/measurement.h"

namespace velour {

/// The slice of one view, and facts about its samples.
struct MeasuredSlice {
  Vec3 wv;
  std::vector<SliceSample> samples;
  double weight = 1;          // weight of the view's squared error in a fit of all views together
  double energy = 0;          // sum of weight x luminance(f cos)^2 that errors are relative to; 0: that of the samples
  double fold = 0;            // relative L2 error of folding (SliceGrid::folded)
  bool interpolated = false;  // from irregular samples, which the fit also reads directly
  std::shared_ptr<const DirectionTree> lights = nullptr;  // of tables: the cells that the samples represent
  size_t out_of_gamut = 0;  // samples with a negative channel: kept, although no model of ours can follow them
};

struct MeasuredSlices {
  std::vector<MeasuredSlice> slices;  // views with samples only
  std::vector<Vec3> uncovered;        // views left out because the measurement does not cover them
};

/// Light directions of a view.
struct SliceGrid {
  int parts;          // of a DirectionTree; 0, or irregular samples, whose interpolation is slow: a light grid
  int rings, spokes;  // of the light grid (brdf/fit/view_grid.h)
  /// Isotropic data: only lights on one side of the plane of incidence, each with the mean of its value and that of its
  /// mirror image (for a view along the normal, the mean over azimuths). For models that are symmetric about that
  /// plane, which get the same fit from half the samples.
  bool folded = false;
};

/// Samples every view that `source` covers at its own lights. `hold_out` leaves out the held-out views and one light in
/// eight. Pairs that the measurement does not cover are left out, never taken for black. `threads` 0: all.
MeasuredSlices sample_slices(const Measurement& source, const SliceGrid& grid, bool hold_out, int threads,
                             Progress& progress);

}  // namespace velour

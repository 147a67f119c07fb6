// The plots of a model: what it is made of, how good it is, what it reflects.
#pragma once

#include <array>
#include <memory>

#include "brdf/measurement.h"
#include "job/progress.h"
#include "model/model.h"
#include "plot/plot.h"

namespace velour {

/// Values are those of VLR_PLOT_* in velour.h.
enum class PlotKind {
  lobes = 0,  // f cos(theta_l) in the plane of incidence of one view: the model, each lobe of it, what was measured
  order = 1,  // error against lobes (of a BTF: against bytes), and the point that the model is
  view_error = 2,  // relative L2 at the reported views, and the tolerance
  albedo = 3,      // directional albedo against the view angle, by channel: the model, and what was measured
  outline = 4,     // share of the tile that the structure of its outline covers, against the view angle
};
inline constexpr std::array<const char*, 5> kPlotNames{"lobes", "order", "view-error", "albedo", "outline"};

/// Polar angle and azimuth, radians: of the lobes' view; of an albedo's views the azimuth. Isotropic models do not
/// depend on the azimuth.
struct PlotView {
  double theta = 30 * kPiD / 180, phi = 0;
};

/// Numbers that only the measurement has are there when it is given. Throws Error(unsupported) with one sentence where
/// the model has nothing of the kind, Error(invalid_argument) for a view that is not above the horizon. Albedos take
/// seconds, lobes of a scattered model the time that its material takes to make.
Plot make_plot(PlotKind kind, const std::shared_ptr<const Model>& model, const Measurement* measurement,
               const PlotView& view, Progress& progress);

}  // namespace velour

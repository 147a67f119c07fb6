// The plots of a model: its lobes, errors, albedo and VOTF.
#pragma once

#include <array>
#include <memory>
#include <vector>
#include "base/progress.h"
#include "brdf/measure/measurement.h"
#include "material/material.h"
#include "model/model.h"
#include "plot/plot.h"

namespace velour {

/// Values are those of VLR_PLOT_* in velour.h.
enum class PlotKind {
  lobes = 0,       // f cos(theta_l) in the plane of incidence of one view: model, its lobes, measurement
  order = 1,       // error against lobes (BTF: against bytes), and the model's point
  view_error = 2,  // relative L2 at the reported views, and the tolerance
  albedo = 3,      // directional albedo against the view angle, by channel: model and measurement
  outline = 4,     // share of the tile covered by the VOTF, against the view angle
};
inline constexpr std::array<const char*, 5> kPlotNames{"lobes", "order", "view-error", "albedo", "outline"};

/// Polar angle and azimuth (radians) of the view of the lobes; albedo plots use only the azimuth. Isotropic models do
/// not depend on the azimuth.
struct PlotView {
  double theta = 30 * kPiD / 180, phi = 0;
};

/// Adds measured data if `measurement` is given. Throws Error(unsupported) with one sentence if the model has no such
/// plot, Error(invalid_argument) for a view that is not above the horizon. Albedo plots take seconds; lobes of a
/// per-view model take the time to construct its material.
Plot make_plot(PlotKind kind, const std::shared_ptr<const Model>& model, const Measurement* measurement,
               const PlotView& view, Progress& progress);

// Plots of the errors recorded by a fit.

/// BRDF: the worst view's error over the tolerance against lobes. BTF: the error against bytes. Throws
/// Error(unsupported) if nothing was recorded.
Plot order_plot(const Model& model);

/// Relative L2 at the reported views. Throws Error(unsupported) if there is none.
Plot view_error_plot(const FitRecord& fit);

// Directional albedo against the view angle.

/// Albedo by channel at views of azimuth `phi` (radians), and that of the measurement at views whose lights it covers
/// almost entirely.
Plot albedo_plot(const Material& material, const Measurement* measurement, double phi, Progress& progress);

// Coverage of a VOTF against the view angle.

/// Share of a tile that its structure covers, at view angles three degrees apart: mean, minimum and maximum over
/// azimuths. Throws Error(unsupported) for a model without a VOTF.
Plot outline_plot(const Model& model, Progress& progress);

// A model in the plane of incidence of one view.

/// Luminance of f cos(theta_l) against the signed theta_l, for the model of a BRDF, each of its lobes, and the
/// measurement: interpolated, or the samples themselves that lie near view and plane. The radius is logarithmic if one
/// peak would hide everything else.
Plot lobes_plot(const std::shared_ptr<const Model>& model, const Measurement* measurement, const PlotView& view);

// Measured values in the plane of incidence of one view.

/// Light direction in the plane of incidence of views of azimuth `phi` (radians), `degrees` from the normal, positive
/// on the side opposite the viewer.
Vec3 light_in_plane(double degrees, double phi);

/// Luminance of f cos(theta_l) against the signed theta_l in degrees, sorted. Tables: interpolated every two
/// degrees, and closer around the mirror direction, where they cover the pair. Irregular samples: those within 2.5
/// degrees of the view and of the plane.
std::vector<PlotPoint> measured_points(const Measurement& measurement, const PlotView& view);

}  // namespace velour

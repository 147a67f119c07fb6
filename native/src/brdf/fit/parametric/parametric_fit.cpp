#include "brdf/fit/parametric/parametric_fit.h"

#include <algorithm>
#include <chrono>

#include "brdf/eval/parametric_material.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/fit_input.h"
#include "brdf/fit/fit_report.h"
#include "brdf/fit/parametric/growth.h"

namespace velour {
namespace {

// Spline cells over the view, for tables and for irregular samples, which are too few for more.
constexpr int kTableCells = 10, kSampleCells = 4;
constexpr int kFinerLobes = 20;

// With fewer irregular samples, a control value follows their noise. Held-out samples count, too, so that the number of
// lobes does not depend on them. A material needs two or three lobes at least.
constexpr size_t kSamplesPerValue = 5;
constexpr int kMinLobes = 3;

// Irregular samples are too few to resolve a finer grid.
SliceGrid grid_for(const Measurement& measurement) {
  return {.parts = 384, .rings = 32, .spokes = 24, .folded = measurement.isotropic()};
}

/// Number of lobes that the irregular samples can determine.
int most_lobes(const Measurement& measurement, int cells) {
  const ViewSpline spline(measurement.isotropic(), cells);
  const auto parameters = static_cast<size_t>(ParametricBrdf::parameters_of(measurement.isotropic()));
  const size_t values = static_cast<size_t>(spline.node_count()) * parameters;
  return std::max(kMinLobes, static_cast<int>(measurement.samples().size() / (kSamplesPerValue * values)));
}

}  // namespace

MeasuredSlices parametric_slices(const Measurement& measurement, const FitOptions& options, Progress& progress) {
  check_options(options, ParametricBrdf::kMaxLobes);
  return read_slices(measurement, grid_for(measurement), options, progress);
}

GrowthOptions growth_options_of(const Measurement& measurement, const FitOptions& options) {
  GrowthOptions growth_options;
  growth_options.isotropic = measurement.isotropic();
  growth_options.cells = measurement.samples().empty() ? kTableCells : kSampleCells;
  growth_options.max_lobes = options.max_lobes;
  if (!measurement.samples().empty()) {
    growth_options.max_lobes = std::min(growth_options.max_lobes, most_lobes(measurement, growth_options.cells));
  }
  growth_options.tolerance = options.tolerance;
  growth_options.threads = options.threads;
  return growth_options;
}

Model parametric_model(const Measurement& measurement, const GrowthResult& fit, const FitOptions& options,
                       Progress& progress) {
  std::vector<FittedView> views;
  for (size_t i = 0; i < fit.views.size(); ++i) views.push_back({Vec3(fit.views[i]), fit.error[i]});
  Model model;
  const auto brdf = std::make_shared<const ParametricBrdf>(fit.brdf);
  model.fit = report_fit(measurement, *make_parametric_material(brdf), options, views, fit.brdf.views, progress);
  model.fit.order = fit.order;
  model.body = *brdf;
  model.source = {measurement.provenance().name, measurement.provenance().format, measurement.provenance().sha256};
  return model;
}

Model fit_finer(const Measurement& measurement, const ParametricBrdf& coarse, const FitOptions& options,
                Progress& progress) {
  progress.stage("sampling", 0.0, 0.1);
  const MeasuredSlices measured = parametric_slices(measurement, options, progress);
  progress.stage("fitting with more lobes", 0.1, 0.9);
  GrowthOptions growth_options = growth_options_of(measurement, options);
  growth_options.max_lobes = std::max(options.max_lobes, kFinerLobes);
  const GrowthResult fit = grow_finer(measured.slices, growth_options, coarse, progress);
  progress.stage("checking the model", 0.9, 1.0);
  Model model = parametric_model(measurement, fit, options, progress);
  warn_of_slices(measured, model.fit.warnings);
  return model;
}

Model fit_parametric(const Measurement& measurement, const FitOptions& options, Progress& progress, double share) {
  const auto start = std::chrono::steady_clock::now();
  progress.stage("sampling", 0.0, 0.1 * share);
  const MeasuredSlices measured = parametric_slices(measurement, options, progress);
  progress.stage("fitting", 0.1 * share, 0.9 * share);
  const GrowthOptions growth_options = growth_options_of(measurement, options);
  GrowthResult fit = grow_lobes(measured.slices, growth_options, progress);
  progress.stage("checking the model", 0.9 * share, share);
  fit.brdf.symmetric = options.symmetric;
  const bool limited = options.limit_albedo && limit_albedo(fit.brdf, options.threads, progress);
  if (limited || options.symmetric) judge_again(measured.slices, growth_options, fit, progress);
  Model model = parametric_model(measurement, fit, options, progress);
  warn_of_slices(measured, model.fit.warnings);
  progress.check();
  progress.update(1.0);
  model.fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return model;
}

}  // namespace velour

#include "fit/scattered_fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "fit/fit_report.h"
#include "fit/lobe_budget.h"
#include "fit/parallel.h"
#include "fit/slice_sampling.h"
#include "fit/stored_lobe.h"
#include "material/scattered_material.h"
#include "srbf/lobe_mixture.h"

namespace velour {
namespace {

// A slice is fitted a little tighter than asked, for what the interpolation between slices adds at the views between.
constexpr double kGoalShare = 0.8;
// With a bound in bytes a view keeps this many lobes if it has them, and there are fewer views rather than poorer ones.
constexpr double kLobesWorthAView = 4;
constexpr uint64_t kLobeBytes = ScatteredBrdf::kLobeBytes, kViewBytes = ScatteredBrdf::kViewBytes;
constexpr int kMeridianNeighbors = 2, kHemisphereNeighbors = 4;

int neighbors_of(bool isotropic) { return isotropic ? kMeridianNeighbors : kHemisphereNeighbors; }

void check_options(const FitOptions& o, bool isotropic) {
  const auto refuse = [](const std::string& sentence) { throw Error(Status::invalid_argument, sentence); };
  if (!(o.tolerance > 0 && o.tolerance <= 1)) {
    refuse("The fit's tolerance is " + std::to_string(o.tolerance) + "; it must be above 0 and at most 1.");
  }
  const int most = LobeMixture::kCapacity / neighbors_of(isotropic);
  if (o.max_lobes < 1 || o.max_lobes > most) {
    refuse("The fit's max_lobes is " + std::to_string(o.max_lobes) + "; it must be 1 to " + std::to_string(most) +
           " for this measurement.");
  }
  if (o.threads < 0) refuse("The fit's threads is " + std::to_string(o.threads) + "; it must be 0 (all) or more.");
  if (o.max_bytes != 0 && o.max_bytes < kViewBytes) {
    refuse("The fit's max_bytes is " + std::to_string(o.max_bytes) + "; one view takes " + std::to_string(kViewBytes) +
           ".");
  }
}

std::vector<ViewPath> fit_slices(const std::vector<MeasuredSlice>& slices, const FitOptions& options,
                                 Progress& progress) {
  std::vector<ViewPath> paths(slices.size());
  parallel_for_each(slices.size(), options.threads, progress, [&](size_t i) {
    const double theta_v = std::acos(std::min(slices[i].wv.z, 1.0f));
    const SliceSamples samples(slices[i].samples);
    const double goal = std::hypot(kGoalShare * tolerance_at(options.tolerance, theta_v), samples.gamut_error());
    paths[i] = {fit_slice(samples, {options.kernel, options.max_lobes, goal}, progress), slices[i].wv.z};
  });
  return paths;
}

/// Leaves out views, then lobes, until the parameters take at most `max_bytes`. True when it had to.
bool fit_into(uint64_t max_bytes, std::vector<MeasuredSlice>& slices, std::vector<ViewPath>& paths) {
  uint64_t lobes = 0;
  for (const ViewPath& p : paths) lobes += p.path.size() - 1;
  if (max_bytes == 0 || lobes * kLobeBytes + paths.size() * kViewBytes <= max_bytes) return false;

  const double mean_lobes = static_cast<double>(lobes) / static_cast<double>(paths.size());
  const double view_bytes = kViewBytes + kLobeBytes * std::min(mean_lobes, kLobesWorthAView);
  const auto keep = std::max<size_t>(1, static_cast<size_t>(static_cast<double>(max_bytes) / view_bytes));
  std::vector<MeasuredSlice> kept_slices;
  std::vector<ViewPath> kept_paths;
  for (const size_t i : thinned(paths.size(), keep)) {
    kept_slices.push_back(std::move(slices[i]));
    kept_paths.push_back(std::move(paths[i]));
  }
  slices = std::move(kept_slices);
  paths = std::move(kept_paths);
  const auto share = share_lobes(paths, (max_bytes - kViewBytes * paths.size()) / kLobeBytes);
  for (size_t i = 0; i < paths.size(); ++i) paths[i].path.resize(share[i] + 1);
  return true;
}

std::shared_ptr<ScatteredBrdf> assemble(const std::vector<MeasuredSlice>& slices, const std::vector<ViewPath>& paths,
                                        bool isotropic, const FitOptions& options) {
  auto brdf = std::make_shared<ScatteredBrdf>();
  brdf->kernel = options.kernel;
  brdf->isotropic = isotropic;
  brdf->align_views = options.align_views;
  brdf->default_neighbors = neighbors_of(isotropic);
  brdf->first_lobe.push_back(0);
  for (size_t i = 0; i < slices.size(); ++i) {
    brdf->views.push_back(slices[i].wv);
    brdf->diffuse.emplace_back(paths[i].path.back().diffuse);
    for (const SliceLobe& lobe : paths[i].path.back().lobes) {
      const StoredLobe stored = stored_lobe(options.kernel, lobe);
      brdf->center.push_back(stored.center);
      brdf->bandwidth.push_back(stored.bandwidth);
      brdf->coefficient.push_back(stored.coefficient);
    }
    brdf->first_lobe.push_back(static_cast<uint32_t>(brdf->center.size()));
  }
  return brdf;
}

void warn_of_gamut(const std::vector<MeasuredSlice>& slices, std::vector<std::string>& warnings) {
  size_t total = 0, outside = 0;
  double cost = 0;
  for (const MeasuredSlice& s : slices) {
    total += s.samples.size();
    outside += s.out_of_gamut;
    cost = std::max(cost, SliceSamples(s.samples).gamut_error());
  }
  if (outside == 0) return;
  warnings.push_back(std::to_string(outside) + " of " + std::to_string(total) +
                     " fitted values have a negative channel (a colour outside Rec. 709), which non-negative "
                     "coefficients cannot follow; alone they cost a relative L2 of up to " +
                     std::to_string(cost));
}

}  // namespace

Model fit_scattered(const Measurement& measurement, const FitOptions& options, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  check_options(options, measurement.isotropic());
  progress.stage("sampling", 0.0, 0.1);
  // Scattered samples are held out one by one, inside the measurement; tables by view and light.
  const auto unseen = options.all_data ? nullptr : measurement.without_held_out();
  const Measurement& source = unseen ? *unseen : measurement;
  auto [slices, uncovered] = sample_slices(source, !options.all_data && !unseen, options.threads, progress);
  if (slices.empty()) {
    throw Error(Status::bad_data, "'" + measurement.provenance().path +
                                      "' has no valid entry at any view direction; there is nothing to fit.");
  }
  progress.stage("fitting", 0.1, 0.95);
  auto paths = fit_slices(slices, options, progress);
  const bool bounded = fit_into(options.max_bytes, slices, paths);
  const auto brdf = assemble(slices, paths, measurement.isotropic(), options);

  progress.stage("checking", 0.95, 1.0);
  std::vector<FittedView> fitted;
  for (size_t i = 0; i < slices.size(); ++i) fitted.push_back({slices[i].wv, paths[i].path.back().relative_l2});
  Model model;
  model.fit = report_fit(measurement, *make_scattered_material(brdf, 0), options, fitted, progress);
  if (bounded) {
    model.fit.warnings.push_back("the bound of " + std::to_string(options.max_bytes) + " bytes leaves " +
                                 std::to_string(slices.size()) + " views and " + std::to_string(brdf->lobe_count()) +
                                 " lobes");
  }
  if (!uncovered.empty()) {
    model.fit.warnings.push_back(std::to_string(uncovered.size()) + " of " +
                                 std::to_string(uncovered.size() + slices.size()) +
                                 " sampled views are outside the measurement and were left out");
  }
  warn_of_gamut(slices, model.fit.warnings);
  model.body = *brdf;
  model.source = {measurement.provenance().name, measurement.provenance().format, measurement.provenance().sha256};
  progress.check();
  progress.update(1.0);
  model.fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return model;
}

}  // namespace velour

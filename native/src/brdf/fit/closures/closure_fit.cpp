#include "brdf/fit/closures/closure_fit.h"

#include <algorithm>
#include <string>
#include <utility>
#include "base/error.h"
#include "base/parallel.h"
#include "brdf/fit/closures/closure_search.h"
#include "brdf/measure/held_out.h"

namespace velour {

namespace {

constexpr int kClosureViews = 36, kFittedLights = 450;
constexpr double kShareOfRoot = 0.1;
constexpr double kNearBestClosures = 1.1;

void check_closure_options(const ClosureFitOptions& o) {
  if (o.max_lobes < 1 || o.max_lobes > kMaxClosureLobes) {
    throw Error(Status::invalid_argument, "The maximum number of glossy lobes (max_lobes) is " +
                                              std::to_string(o.max_lobes) + "; it must be 1, 2 or 3.");
  }
  if (!(o.tolerance > 0)) {
    throw Error(Status::invalid_argument, "The tolerance of a fit of closures (tolerance) is " +
                                              std::to_string(o.tolerance) + "; it must be positive.");
  }
}

/// Targets at 1.25 + 2.5 i degrees.
std::vector<ClosureTarget> fitted_targets(const ClosureSource& source, const HighlightWidths& widths, int threads,
                                          const Progress& progress) {
  std::vector<std::vector<ClosureTarget>> one_each(kClosureViews);
  parallel_pieces(one_each.size(), threads, progress, [&](size_t i) {
    one_each[i].push_back(
        closure_target(source, widths, radians_from(1.25f + 2.5f * static_cast<float>(i)), kFittedLights));
    emphasize_dim(one_each[i].back(), kShareOfRoot);
  });
  std::vector<ClosureTarget> targets;
  for (auto& one : one_each) targets.push_back(std::move(one[0]));
  return targets;
}

/// The fewest lobes that are good enough.
ClosureFit& chosen_of(std::vector<ClosureFit>& fits, double tolerance) {
  double best = visible_closure_error(fits[0].errors);
  for (const ClosureFit& f : fits) best = std::min(best, visible_closure_error(f.errors));
  return *std::find_if(fits.begin(), fits.end(), [&](const ClosureFit& f) {
    return visible_closure_error(f.errors) < std::max(tolerance, kNearBestClosures * best);
  });
}

ClosureFit black_closures(const ClosureFitOptions& options) {
  ClosureFit fit{.masking = options.masking};
  fit.network.lobes.resize(1);
  fit.network.lobes[0].roughness.fill(1);
  for (const int degrees : kHeldOutViews) fit.errors.push_back({degrees, 0, 0, 0});
  return fit;
}

}  // namespace

ClosureFit fit_closures(const ClosureSource& source, const ClosureFitOptions& options, Progress& progress) {
  check_closure_options(options);
  progress.stage("reading the material", 0, 0.2);
  const HighlightWidths widths = highlight_widths(source);
  const std::vector<ClosureView> views = closure_views(fitted_targets(source, widths, options.threads, progress));
  if (views.empty()) return black_closures(options);
  const ClosureJudge judge(source, widths, options.threads, progress);
  const ClosureAlbedo albedo(source, widths, options.threads, progress);

  // A half vector turns by half the angle of the light about the viewer.
  const double narrowest = static_cast<double>(std::min(widths.mirror, 0.5f * widths.viewer));
  const ClosureSearchOptions search{
      .masking = options.masking, .bounds = {.min_alpha = 0.5 * narrowest}, .threads = options.threads};
  ClosureSolution solution;
  std::vector<ClosureFit> fits;
  while (static_cast<int>(fits.size()) < options.max_lobes) {
    const auto done = static_cast<double>(fits.size());
    progress.stage("fitting closures", 0.2 + 0.8 * done / options.max_lobes,
                   0.2 + 0.8 * (done + 1) / options.max_lobes);
    solution = one_more_lobe(views, solution, search, progress);
    ClosureFit fit{.network = closure_network(solution.unknowns, solution.distributions, search.bounds),
                   .masking = options.masking};
    albedo.correct(fit.network, options.masking);
    fit.errors = judge.errors(fit.network, options.masking);
    fit.mean_error = mean_closure_error(fit.errors);
    fits.push_back(std::move(fit));
    if (visible_closure_error(fits.back().errors) < options.tolerance) break;
  }
  ClosureFit chosen = std::move(chosen_of(fits, options.tolerance));
  chosen.azimuth_error = mean_closure_error(judge.errors_of_mean());
  chosen.albedo_excess = albedo.largest_excess(chosen.network, options.masking);
  return chosen;
}

}  // namespace velour

#include "brdf/fit/closures/closure_fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "brdf/fit/closures/closure_search.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/measure/held_out.h"
#include "model/model.h"

namespace velour {

namespace {

constexpr int kJudgedLights = 1024, kAlbedoLights = 512, kLastMeanView = 75;

/// Relative root of a sum of squares; a black reference gives 0 for a black model and 1 for any other.
double relative_root(double error_sq, double reference_sq) {
  return reference_sq > 0 ? std::sqrt(error_sq / reference_sq) : (error_sq > 0 ? 1.0 : 0.0);
}

/// Error of the network at all azimuths.
ClosureViewError error_of(const std::vector<ClosureTarget>& azimuths, int degrees, const ClosureNetwork& network,
                          LobeMasking masking) {
  double error_sq = 0, reference_sq = 0, luminance_error_sq = 0, luminance_sq = 0, root_error_sq = 0, root_sq = 0;
  for (const ClosureTarget& target : azimuths) {
    const AlignedArray<float> values = closure_values(network, masking, target.lights);
    const size_t row = target.lights.padded();
    const float* root_weight = target.lights.root_weight();
    for (size_t i = 0; i < row; ++i) {
      const Rgb difference(values.data()[i] - target.channel(0)[i], values.data()[row + i] - target.channel(1)[i],
                           values.data()[2 * row + i] - target.channel(2)[i]);
      error_sq += static_cast<double>(glm::dot(difference, difference));
      luminance_error_sq += static_cast<double>(luminance(difference) * luminance(difference));
      for (int c = 0; c < 3; ++c) {  // the weight times the squared difference of roots
        const float source = target.channel(c)[i], model = values.data()[static_cast<size_t>(c) * row + i];
        const float root = std::sqrt(model) - std::sqrt(source);
        root_error_sq += static_cast<double>(root_weight[i] * root * root);
        root_sq += static_cast<double>(root_weight[i] * source);
      }
    }
    reference_sq += target.norm_sq.r + target.norm_sq.g + target.norm_sq.b;
    luminance_sq += target.norm_sq_luminance;
  }
  return {degrees, relative_root(luminance_error_sq, luminance_sq), relative_root(error_sq, reference_sq),
          relative_root(root_error_sq, root_sq)};
}

}  // namespace

ClosureJudge::ClosureJudge(const ClosureSource& source, const HighlightWidths& widths, int threads,
                           const Progress& progress)
    : views_(kHeldOutViews.size()) {
  parallel_pieces(views_.size(), threads, progress, [&](size_t v) {
    const float theta_v = radians_from(static_cast<float>(kHeldOutViews[v]));
    for (const float phi_v : closure_azimuths(source)) {
      views_[v].push_back(closure_target(source, widths, theta_v, kJudgedLights, phi_v));
    }
  });
}

std::vector<ClosureViewError> ClosureJudge::errors(const ClosureNetwork& network, LobeMasking masking) const {
  std::vector<ClosureViewError> errors;
  for (size_t v = 0; v < views_.size(); ++v) {
    errors.push_back(error_of(views_[v], kHeldOutViews[v], network, masking));
  }
  return errors;
}

namespace {

/// Mean of `error_at` over the views up to 75 degrees.
double mean_up_to_75(const std::vector<ClosureViewError>& errors, const auto& error_at) {
  double sum = 0;
  int count = 0;
  for (const ClosureViewError& e : errors) {
    if (e.degrees > kLastMeanView) continue;
    sum += error_at(e);
    ++count;
  }
  return sum / count;
}

}  // namespace

double mean_closure_error(const std::vector<ClosureViewError>& errors) {
  return mean_up_to_75(errors, [](const ClosureViewError& e) { return e.luminance; });
}

double visible_closure_error(const std::vector<ClosureViewError>& errors) {
  return mean_up_to_75(errors, [](const ClosureViewError& e) { return 0.5 * (e.luminance + e.root); });
}

ClosureAlbedo::ClosureAlbedo(const ClosureSource& source, const HighlightWidths& widths, int threads,
                             const Progress& progress)
    : views_(2 * kClosureSamples - 1), albedo_(views_.size(), Vec3d(0)) {
  const std::vector<float> azimuths = closure_azimuths(source);
  parallel_pieces(views_.size(), threads, progress, [&](size_t i) {
    const float degrees = 90.0f * static_cast<float>(i) / (2 * kClosureSamples - 2);
    const float theta_v = radians_from(std::min(degrees, 89.5f));
    for (const float phi_v : azimuths) {
      ClosureTarget target = closure_target(source, widths, theta_v, kAlbedoLights, phi_v);
      albedo_[i] += target.albedo / static_cast<double>(azimuths.size());
      views_[i].push_back(std::move(target.lights));
    }
  });
  for (const Vec3d& albedo : albedo_) largest_ = std::max({largest_, albedo.r, albedo.g, albedo.b});
}

Vec3d ClosureAlbedo::albedo_of(const ClosureNetwork& network, LobeMasking masking, size_t view) const {
  Vec3d sum(0);
  for (const ClosureLights& lights : views_[view]) {
    const AlignedArray<float> values = closure_values(network, masking, lights);
    for (int c = 0; c < 3; ++c) {
      const float* row = values.data() + static_cast<size_t>(c) * lights.padded();
      for (size_t i = 0; i < lights.padded(); ++i) sum[c] += static_cast<double>(row[i] * lights.root_weight()[i]);
    }
  }
  return sum / static_cast<double>(views_[view].size());
}

void ClosureAlbedo::correct(ClosureNetwork& network, LobeMasking masking) const {
  constexpr double kSlack = 0.008, kMinShare = 0.01, kLargestGain = 1.25;
  std::vector<Vec3d> ratio(views_.size());  // albedo of the source over that of the network
  for (size_t v = 0; v < views_.size(); ++v) {
    const Vec3d model = albedo_of(network, masking, v);
    for (int c = 0; c < 3; ++c) ratio[v][c] = model[c] > 0 ? albedo_[v][c] / model[c] : 1;
  }
  for (size_t i = 0; i < kClosureSamples; ++i) {
    const size_t v = 2 * i;
    Rgb factor;
    for (int c = 0; c < 3; ++c) {
      // The last view, at 89.5 degrees, lies between the last two samples.
      const size_t first = v > 0 ? v - 1 : 0, last = i + 2 >= kClosureSamples ? views_.size() - 1 : v + 1;
      double most = ratio[v][c];
      for (size_t near = first; near <= last; ++near) most = std::min(most, ratio[near][c]);
      const bool dark = albedo_[v][c] < kMinShare * largest_;
      const double least = dark ? 0 : std::min(ratio[v][c] * (1 - kSlack), kLargestGain);
      factor[c] = static_cast<float>(std::min(std::max(1.0, least), most * (1 + kSlack)));
    }
    network.diffuse[i] *= factor;
    for (ClosureLobe& lobe : network.lobes) lobe.weight[i] *= factor;
  }
}

double ClosureAlbedo::largest_excess(const ClosureNetwork& network, LobeMasking masking) const {
  double excess = 0;
  for (size_t v = 0; v < views_.size(); ++v) {
    const Vec3d model = albedo_of(network, masking, v);
    for (int c = 0; c < 3; ++c) {
      if (albedo_[v][c] > 1e-4 * largest_) excess = std::max(excess, model[c] / albedo_[v][c] - 1);
    }
  }
  return excess;
}

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

/// Targets at 1.25 + 2.5 i degrees; of an anisotropic source two azimuths each, others at each polar angle.
std::vector<ClosureTarget> fitted_targets(const ClosureSource& source, const HighlightWidths& widths, int threads,
                                          const Progress& progress) {
  const std::vector<float> azimuths = closure_azimuths(source, kClosureViews);
  std::vector<std::vector<ClosureTarget>> at_angle(kClosureViews);
  parallel_pieces(at_angle.size(), threads, progress, [&](size_t i) {
    const float theta_v = radians_from(1.25f + 2.5f * static_cast<float>(i)), phi_v = azimuths[i % azimuths.size()];
    at_angle[i].push_back(closure_target(source, widths, theta_v, kFittedLights, phi_v));
    if (!source.isotropic) {
      at_angle[i].push_back(closure_target(source, widths, theta_v, kFittedLights, phi_v + 0.5f * kPi));
    }
    for (ClosureTarget& target : at_angle[i]) emphasize_dim(target, kShareOfRoot);
  });
  std::vector<ClosureTarget> targets;
  for (auto& views : at_angle) std::move(views.begin(), views.end(), std::back_inserter(targets));
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
  // Cycles before Blender 3.5 draws directions of stretched Beckmann lobes as if these were as wide along y as along x.
  const ClosureBounds bounds{.min_alpha = 0.5 * narrowest,
                             .frame = source.isotropic ? ClosureFrame::incidence : ClosureFrame::surface,
                             .stretched_beckmann = options.masking != LobeMasking::separable};
  const ClosureSearchOptions search{.masking = options.masking, .bounds = bounds, .threads = options.threads};
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
  chosen.albedo_excess = albedo.largest_excess(chosen.network, options.masking);
  return chosen;
}

namespace {

constexpr double kLargeClosureError = 0.05;

std::string percent(double share) { return std::to_string(std::lround(100 * share)) + " %"; }

/// Why the error is large; empty if it is not.
std::string reason_of(const ClosureFit& fit) {
  if (!(fit.mean_error > kLargeClosureError)) return {};
  const auto worst =
      std::max_element(fit.errors.begin(), fit.errors.end() - 1,  // without 85 degrees, as the mean
                       [](const ClosureViewError& a, const ClosureViewError& b) { return a.luminance < b.luminance; });
  const size_t lobes = fit.network.lobes.size();
  return "The highlights have shapes that " + std::to_string(lobes) +
         (lobes == 1 ? " glossy closure" : " glossy closures") + " cannot take, above all at " +
         std::to_string(worst->degrees) + " degrees (" + percent(worst->luminance) + ").";
}

}  // namespace

ModelClosures fit_measurement_closures(const Measurement& measurement, const ClosureFitOptions& options,
                                       Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const ClosureSource source{[&](const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f) {
                               std::vector<uint8_t> valid(wl.size());
                               measurement.eval(wv, wl, f, valid);
                             },
                             measurement.isotropic()};
  ClosureFit fit = fit_closures(source, options, progress);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::string reason = reason_of(fit);
  return {std::move(fit), seconds, std::move(reason)};
}

ModelClosures fit_model_closures(const std::shared_ptr<const Model>& model, const ClosureFitOptions& options,
                                 Progress& progress) {
  if (is_btf(*model)) {
    throw Error(Status::unsupported,
                "The model of \"" + model->source.name +
                    "\" is of a BTF, whose texture closures of one BRDF cannot show; fit closures to "
                    "a model of a BRDF.");
  }
  return fit_measurement_closures(MaterialMeasurement(make_material(model, 0)), options, progress);
}

}  // namespace velour

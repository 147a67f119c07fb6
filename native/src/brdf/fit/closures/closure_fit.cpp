#include "brdf/fit/closures/closure_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include "base/error.h"
#include "base/parallel.h"
#include "brdf/fit/closures/closure_problem.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/measure/held_out.h"
#include "math/sphere/directions.h"

namespace velour {

// Accuracy of a network.

namespace {

constexpr int kJudgedLights = 4096, kLastMeanView = 75;

/// f cos of the source at the views of the report, for the same lights.
struct JudgedViews {
  std::vector<Vec3> wl = hemisphere_fibonacci(kJudgedLights);
  std::vector<std::vector<Rgb>> f_cos;  // of each of kHeldOutViews
};

float radians_of(int degrees) { return radians_from(static_cast<float>(degrees)); }

JudgedViews judged_views(const ClosureSource& source, bool isotropic, int threads, const Progress& progress) {
  JudgedViews views;
  views.f_cos.resize(kHeldOutViews.size());
  parallel_pieces(views.f_cos.size(), threads, progress, [&](size_t i) {
    views.f_cos[i] = closure_values(source, isotropic, radians_of(kHeldOutViews[i]), views.wl);
  });
  return views;
}

/// Relative root of a sum of squares; a black reference gives 0 for a black model and 1 for any other.
double relative_root(double error_sq, double reference_sq) {
  return reference_sq > 0 ? std::sqrt(error_sq / reference_sq) : (error_sq > 0 ? 1.0 : 0.0);
}

ClosureViewError error_at(const JudgedViews& views, size_t view, const ClosureFit& fit) {
  const ClosuresAtView closures(fit.network, fit.masking, radians_of(kHeldOutViews[view]));
  double error_sq = 0, reference_sq = 0, luminance_error_sq = 0, luminance_sq = 0;
  for (size_t i = 0; i < views.wl.size(); ++i) {
    const Rgb reference = views.f_cos[view][i], difference = closures.f_cos(views.wl[i]) - reference;
    error_sq += glm::dot(difference, difference);
    reference_sq += glm::dot(reference, reference);
    luminance_error_sq += luminance(difference) * luminance(difference);
    luminance_sq += luminance(reference) * luminance(reference);
  }
  return {kHeldOutViews[view], relative_root(luminance_error_sq, luminance_sq), relative_root(error_sq, reference_sq)};
}

void set_errors(const JudgedViews& views, int threads, const Progress& progress, ClosureFit& fit) {
  fit.errors.resize(kHeldOutViews.size());
  parallel_pieces(fit.errors.size(), threads, progress, [&](size_t i) { fit.errors[i] = error_at(views, i, fit); });
  double sum = 0;
  int count = 0;
  for (const ClosureViewError& e : fit.errors) {
    if (e.degrees > kLastMeanView) continue;
    sum += e.luminance;
    ++count;
  }
  fit.mean_error = sum / count;
}

}  // namespace

// Albedo.

namespace {

constexpr int kAlbedoLights = 1024;
constexpr float kAlbedoSlack = 1.01f;

/// The source at an angle: light directions with solid angles, and albedos.
struct AlbedoView {
  float theta_v;
  WeightedLights lights;
  Rgb albedo;
};

Rgb closure_albedo_over(const WeightedLights& lights, const auto& f_cos) {
  Vec3d sum(0);
  for (size_t i = 0; i < lights.wl.size(); ++i) sum += lights.weight[i] * Vec3d(f_cos(i));
  return Rgb(sum);
}

AlbedoView albedo_view(const ClosureSource& source, bool isotropic, float theta_v) {
  AlbedoView view{theta_v, closure_lights(theta_v, kAlbedoLights), Rgb(0)};
  const std::vector<Rgb> f_cos = closure_values(source, isotropic, theta_v, view.lights.wl);
  view.albedo = closure_albedo_over(view.lights, [&](size_t i) { return f_cos[i]; });
  return view;
}

std::vector<AlbedoView> albedo_views(const ClosureSource& source, bool isotropic, int threads,
                                     const Progress& progress) {
  std::vector<AlbedoView> views(2 * kClosureSamples - 1);  // at the samples of ClosureCurve and halfway between them
  parallel_pieces(views.size(), threads, progress, [&](size_t i) {
    const float degrees = 90.0f * static_cast<float>(i) / (2 * kClosureSamples - 2);
    views[i] = albedo_view(source, isotropic, radians_from(std::min(degrees, 89.5f)));
  });
  return views;
}

Rgb model_albedo(const ClosureFit& fit, const AlbedoView& view) {
  const ClosuresAtView closures(fit.network, fit.masking, view.theta_v);
  return closure_albedo_over(view.lights, [&](size_t i) { return closures.f_cos(view.lights.wl[i]); });
}

/// Reduces the weights of channels that reflect too much, one sample of the curves at a time.
void limit_albedo(const std::vector<AlbedoView>& views, int threads, const Progress& progress, ClosureFit& fit) {
  std::vector<Rgb> factor(views.size());
  parallel_pieces(views.size(), threads, progress, [&](size_t i) {
    const Rgb model = model_albedo(fit, views[i]);
    for (int c = 0; c < 3; ++c) {
      const float most = kAlbedoSlack * views[i].albedo[c];
      factor[i][c] = model[c] > most ? most / model[c] : 1.0f;
    }
  });
  for (size_t i = 0; i < kClosureSamples; ++i) {
    Rgb least = factor[2 * i];
    if (i > 0) least = glm::min(least, factor[2 * i - 1]);
    if (i + 1 < kClosureSamples) least = glm::min(least, factor[2 * i + 1]);
    fit.network.diffuse[i] *= least;
    for (ClosureLobe& lobe : fit.network.lobes) lobe.weight[i] *= least;
    for (int c = 0; c < 3; ++c) fit.largest_cut = std::max(fit.largest_cut, 1.0 - static_cast<double>(least[c]));
  }
}

ClosureAlbedoError albedo_error(const AlbedoView& view, const ClosureFit& fit) {
  const Rgb model = model_albedo(fit, view);
  Rgb relative(0);
  for (int c = 0; c < 3; ++c) {
    if (view.albedo[c] > 0) relative[c] = model[c] / view.albedo[c] - 1;
  }
  return {static_cast<double>(view.theta_v) * 180 / kPiD, relative};
}

}  // namespace

// Descents from nested starts.

namespace {

/// Unknowns and what they stand for.
struct ClosureSolution {
  std::vector<LobeDistribution> distributions;
  ClosureUnknowns unknowns;
  double cost = 0;
};

/// Shape of a lobe that is added: alpha at the knots, and the tilt relative to theta_v.
struct AddedLobe {
  std::array<double, kClosureKnots> alpha;
  double tilt;
};

/// The descents of one fit.
class ClosureDescents {
 public:
  ClosureDescents(const std::vector<ClosureViewSamples>& views, const ClosureFitOptions& options, Progress& progress)
      : views_(views),
        options_(options),
        bounds_{.min_alpha = options.min_alpha, .limit_tilt = options.limit_tilt},
        progress_(progress) {}

  const ClosureBounds& bounds() const { return bounds_; }

  ClosureSolution one_lobe() const {
    std::vector<ClosureUnknowns> starts;
    for (const double alpha : {0.05, 0.2, 0.5}) starts.push_back(with_lobe(lambert(), 0, flat(alpha, 0), 0.7));
    const ClosureSolution plain = best({LobeDistribution::ggx}, starts, {.tilt = false, .anisotropy = false});
    if (!options_.tilt && !options_.anisotropy) return plain;
    const ClosureSolution tilted =
        best(plain.distributions, {plain.unknowns}, {.tilt = options_.tilt, .anisotropy = false});
    return options_.anisotropy ? best(plain.distributions, {tilted.unknowns}, all_freedoms()) : tilted;
  }

  /// `from` with one more lobe, inserted as lobe `place`.
  ClosureSolution one_more(const ClosureSolution& from, LobeDistribution distribution, int place) const {
    std::vector<LobeDistribution> distributions = from.distributions;
    distributions.insert(distributions.begin() + place, distribution);
    std::vector<ClosureUnknowns> starts;
    for (const AddedLobe& lobe : added_lobes(from)) {
      starts.push_back(with_lobe(from.unknowns, place, lobe, 0.25));
    }
    return best(distributions, starts, all_freedoms());
  }

 private:
  ClosureFreedoms all_freedoms() const {
    return {.tilt = options_.tilt, .anisotropy = options_.anisotropy, .pin_anisotropy = options_.pin_anisotropy};
  }

  ClosureSolution best(const std::vector<LobeDistribution>& distributions, const std::vector<ClosureUnknowns>& starts,
                       const ClosureFreedoms& freedoms) const {
    const ClosureProblem problem(views_, distributions, options_.masking, bounds_, freedoms);
    std::vector<Candidate<ClosureUnknowns>> candidates;
    for (const ClosureUnknowns& u : starts) candidates.push_back({u, 0});
    ClosureUnknowns u = best_descent(problem, std::move(candidates), options_.threads, progress_);
    u = descend(problem, u, [&] { progress_.check(); });  // the best may have used up its steps
    ClosureSolution found{distributions, u};
    found.cost = problem.cost(found.unknowns);
    return found;
  }

  /// Albedo of the material at a knot, by linear interpolation between the views.
  Rgb albedo_at(double theta_v) const {
    size_t i = 0;
    while (i + 2 < views_.size() && views_[i + 1].theta_v < theta_v) ++i;
    const ClosureViewSamples &a = views_[i], &b = views_[i + 1];
    const double t = std::clamp((theta_v - a.theta_v) / (b.theta_v - a.theta_v), 0.0, 1.0);
    Rgb albedo;
    for (int c = 0; c < 3; ++c) albedo[c] = static_cast<float>(a.albedo[c] + t * (b.albedo[c] - a.albedo[c]));
    return albedo;
  }

  static AddedLobe flat(double alpha, double tilt) {
    AddedLobe lobe{.alpha = {}, .tilt = tilt};
    lobe.alpha.fill(alpha);
    return lobe;
  }

  /// A diffuse material with the albedo of the measured one.
  ClosureUnknowns lambert() const {
    ClosureUnknowns u(kClosureKnots, 3);
    const auto knots = closure_knots();
    for (int k = 0; k < kClosureKnots; ++k) {
      const Rgb albedo = albedo_at(knots[static_cast<size_t>(k)]);
      for (int c = 0; c < 3; ++c) u(k, c) = std::sqrt(static_cast<double>(albedo[c]));
    }
    return u;
  }

  /// `from` times 1 - `share`, with a lobe of `share` of the material's albedo in place `place`.
  ClosureUnknowns with_lobe(const ClosureUnknowns& from, int place, const AddedLobe& lobe, double share) const {
    const int at = lobe_unknown(place), rest = static_cast<int>(from.cols()) - at;
    ClosureUnknowns u(kClosureKnots, from.cols() + 6);
    u.leftCols(at) = from.leftCols(at);
    u.rightCols(rest) = from.rightCols(rest);
    u.leftCols(3) *= std::sqrt(1 - share);
    for (int first = 3; first < u.cols(); first += 6) u.middleCols(first, 3) *= std::sqrt(1 - share);
    const auto knots = closure_knots();
    for (int k = 0; k < kClosureKnots; ++k) {
      const double theta = knots[static_cast<size_t>(k)];
      const Rgb albedo = albedo_at(theta);
      for (int c = 0; c < 3; ++c) u(k, at + c) = std::sqrt(share * static_cast<double>(albedo[c]) + 1e-6);
      u(k, at + 3) = closure_alpha_unknown(lobe.alpha[static_cast<size_t>(k)], bounds_);
      u(k, at + 4) = lobe.tilt != 0 ? closure_tilt_unknown(lobe.tilt, theta, bounds_) : 0;
      u(k, at + 5) = 0;
    }
    return u;
  }

  /// Lobes narrower and wider than the strongest of `from`, and one that points at the viewer.
  std::vector<AddedLobe> added_lobes(const ClosureSolution& from) const {
    int strongest = 0;
    for (int k = 1; k < static_cast<int>(from.distributions.size()); ++k) {
      if (strength(from, k) > strength(from, strongest)) strongest = k;
    }
    std::vector<AddedLobe> lobes{flat(0, 0), flat(0, 0)};
    const auto knots = closure_knots();
    for (int k = 0; k < kClosureKnots; ++k) {
      const double unknown = from.unknowns(k, lobe_unknown(strongest) + 3);
      const auto knot = static_cast<size_t>(k);
      const double alpha = closure_shape(unknown, 0, 0, knots[knot], bounds_).alpha;
      lobes[0].alpha[knot] = 0.35 * alpha;
      lobes[1].alpha[knot] = 2.5 * alpha;
    }
    if (options_.tilt) lobes.push_back(flat(0.3, 0.8));
    return lobes;
  }

  static double strength(const ClosureSolution& from, int k) {
    return from.unknowns.middleCols(lobe_unknown(k), 3).squaredNorm();
  }

  const std::vector<ClosureViewSamples>& views_;
  const ClosureFitOptions& options_;
  ClosureBounds bounds_;
  Progress& progress_;
};

}  // namespace

// The number of lobes.

namespace {

constexpr double kNearBestClosures = 1.1;

void check_closure_options(const ClosureFitOptions& o) {
  if (o.max_lobes < 1 || o.max_lobes > kMaxClosureLobes) {
    throw Error(Status::invalid_argument, "The maximum number of glossy lobes (max_lobes) is " +
                                              std::to_string(o.max_lobes) + "; it must be 1, 2 or 3.");
  }
  if (!(o.min_alpha >= 0.002 && o.min_alpha <= 0.5)) {
    throw Error(Status::invalid_argument, "The smallest alpha of a glossy lobe (min_alpha) is " +
                                              std::to_string(o.min_alpha) + "; it must be between 0.002 and 0.5.");
  }
}

ClosureSolution next_solution(const ClosureDescents& descents, const std::vector<ClosureSolution>& found,
                              bool beckmann) {
  const int lobes = static_cast<int>(found.size());
  if (lobes == 0) return descents.one_lobe();
  ClosureSolution ggx = descents.one_more(found.back(), LobeDistribution::ggx, lobes);
  if (lobes != 2 || !beckmann) return ggx;
  ClosureSolution mixed = descents.one_more(found.back(), LobeDistribution::beckmann, 1);
  return mixed.cost < ggx.cost ? mixed : ggx;
}

/// The fewest lobes that are good enough.
ClosureFit& chosen_of(std::vector<ClosureFit>& fits, double tolerance) {
  double best = fits[0].mean_error;
  for (const ClosureFit& f : fits) best = std::min(best, f.mean_error);
  return *std::find_if(fits.begin(), fits.end(), [&](const ClosureFit& f) {
    return f.mean_error < tolerance || f.mean_error <= kNearBestClosures * best;
  });
}

ClosureFit black_closures(const ClosureFitOptions& options) {
  ClosureFit fit{.masking = options.masking};
  fit.network.lobes.resize(1);
  fit.network.lobes[0].roughness.fill(1);
  for (const int degrees : kHeldOutViews) fit.errors.push_back({degrees, 0, 0});
  return fit;
}

}  // namespace

ClosureFit fit_closures(const ClosureSource& source, bool isotropic, const ClosureFitOptions& options,
                        Progress& progress) {
  check_closure_options(options);
  progress.stage("reading the material", 0, 0.1);
  const std::vector<ClosureViewSamples> views = closure_samples(source, isotropic, options.threads, progress);
  if (views.empty()) return black_closures(options);
  const JudgedViews judged = judged_views(source, isotropic, options.threads, progress);
  const std::vector<AlbedoView> albedos = albedo_views(source, isotropic, options.threads, progress);

  const ClosureDescents descents(views, options, progress);
  std::vector<ClosureSolution> solutions;
  std::vector<ClosureFit> fits;
  while (static_cast<int>(fits.size()) < options.max_lobes) {
    const auto done = static_cast<double>(fits.size());
    progress.stage("fitting closures", 0.1 + 0.9 * done / options.max_lobes,
                   0.1 + 0.9 * (done + 1) / options.max_lobes);
    solutions.push_back(next_solution(descents, solutions, options.beckmann));
    const ClosureSolution& s = solutions.back();
    ClosureFit fit{.network = closure_network(s.unknowns, s.distributions, descents.bounds()),
                   .masking = options.masking};
    limit_albedo(albedos, options.threads, progress, fit);
    set_errors(judged, options.threads, progress, fit);
    fits.push_back(std::move(fit));
    if (fits.back().mean_error < options.tolerance) break;
  }
  ClosureFit chosen = std::move(chosen_of(fits, options.tolerance));
  chosen.albedo.resize(views.size());
  parallel_pieces(views.size(), options.threads, progress, [&](size_t i) {
    const AlbedoView view = albedo_view(source, isotropic, static_cast<float>(views[i].theta_v));
    chosen.albedo[i] = albedo_error(view, chosen);
  });
  return chosen;
}

ClosureFit fit_closures(const Material& material, const ClosureFitOptions& options, Progress& progress) {
  const ClosureSource source = [&](const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f) {
    evaluate(material, wv, wl, f);
  };
  return fit_closures(source, material.isotropic(), options, progress);
}

}  // namespace velour

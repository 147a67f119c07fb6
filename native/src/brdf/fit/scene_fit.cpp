#include "brdf/fit/scene_fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/parametric/parametric_fit.h"
#include "usage/picture_error.h"

namespace velour {

namespace {

constexpr int kCells[] = {1, 2, 3, 4};
constexpr size_t kMinViews = 4;
// Minimum weight of a view, relative to the mean, for views that were hardly seen.
constexpr double kMinViewWeight = 0.05;
// The picture error decides how many lobes are enough, so views are fitted far more tightly than the tolerance.
constexpr double kSceneGoalShare = 0.1;

// Standard errors by which a model must stay below the bound. Otherwise the luckiest of many would win.
constexpr double kSure = 2;
// Allowed relative increase of the relmse of pictures.
constexpr double kSlack = 0.05;
// relmse of an error of a thousandth of the light. Pictures cannot distinguish models with smaller errors.
constexpr double kUnseen = 1e-6;

// Shares of the progress: fit of the full model, if needed, and reading of the slices.
constexpr double kFullShare = 0.5, kReadingShare = 0.1;

double polar_angle(const Vec3& w) { return std::acos(std::clamp(static_cast<double>(w.z), -1.0, 1.0)); }

/// Weight of the observed views within a degree and a half of `theta` (radians).
double seen_weight(const SceneDomain& domain, double theta) {
  const int bin = static_cast<int>(theta / (kPiD / 2) * SceneDomain::kViewBins);
  double sum = 0;
  for (int i = std::max(bin - 1, 0); i <= std::min(bin + 1, SceneDomain::kViewBins - 1); ++i)
    sum += domain.view[static_cast<size_t>(i)];
  return sum;
}

/// The slices within the range, at least the kMinViews nearest, weighted by the observed views and lights.
std::vector<MeasuredSlice> seen_slices(std::vector<MeasuredSlice> slices, const ViewRange& range,
                                       const SceneObservation& observation) {
  const auto outside = [&range](const MeasuredSlice& s) {
    const double theta = polar_angle(s.wv);
    return std::max({range.first() - theta, theta - range.last(), 0.0});
  };
  std::stable_sort(slices.begin(), slices.end(), [&](const auto& a, const auto& b) { return outside(a) < outside(b); });
  size_t kept = 0;
  while (kept < slices.size() && (kept < kMinViews || outside(slices[kept]) <= 0)) ++kept;
  slices.erase(slices.begin() + static_cast<std::ptrdiff_t>(kept), slices.end());

  const LightImportance importance(observation);
  double mean = 0;
  for (MeasuredSlice& s : slices) {
    s.weight = seen_weight(observation.domain, polar_angle(s.wv));
    mean += s.weight / static_cast<double>(slices.size());
    if (s.energy > 0) continue;  // bins of irregular samples
    for (SliceSample& sample : s.samples) sample.weight *= static_cast<float>(importance(s.wv, sample.wl));
  }
  for (MeasuredSlice& s : slices) s.weight = mean > 0 ? std::max(s.weight / mean, kMinViewWeight) : 1;
  return slices;
}

/// Searches for the smallest model whose pictures are no worse than those of the full model.
class SceneSearch {
 public:
  SceneSearch(const std::vector<MeasuredSlice>& slices, const GrowthOptions& growth_options, bool limit,
              const PictureError& judge, const ParametricBrdf& full, Progress& progress)
      : slices_(slices),
        growth_options_(growth_options),
        limit_(limit),
        judge_(judge),
        progress_(progress),
        full_shares_(judge.shares(full)) {
    growth_options_.tolerance *= kSceneGoalShare;
    growth_options_.seen_evenly = false;
    least_bytes_ = full.parameter_bytes();
  }

  /// Covers `begin` to `end` of the task's progress, one step per number of cells. The fits report their own progress
  /// to a stage of zero width.
  void run(double begin, double end) {
    const int most = growth_options_.cells;
    double at = begin;
    for (const int cells : kCells) {
      if (cells > most) break;
      progress_.stage("fitting the scene model", at, at);
      at += (end - begin) / static_cast<double>(std::size(kCells));
      growth_options_.cells = cells;
      try_lobes();
    }
  }

  /// Nothing if no smaller model is good enough.
  std::optional<GrowthResult>& best() { return best_; }
  const std::vector<double>& full_shares() const { return full_shares_; }

 private:
  uint64_t bytes_of(int lobes) const {
    ParametricBrdf brdf;
    brdf.isotropic = growth_options_.isotropic;
    brdf.cells = growth_options_.cells;
    brdf.views = growth_options_.views;
    brdf.space.resize(static_cast<size_t>(lobes));
    return ParametricBrdf::parameter_bytes(brdf.index(brdf.spline().node_count(), 0, 0), brdf.space.size());
  }

  /// Finds the fewest lobes that are enough, if that makes a smaller model than the best so far. Goes upwards: small
  /// fits are fast, and a fit that ended with fewer lobes than allowed ends the same if more are allowed.
  void try_lobes() {
    growth_options_.max_lobes = ParametricBrdf::kMaxLobes;
    LobeGrowth growth(slices_, growth_options_, progress_);
    for (int lobes = 1; lobes <= ParametricBrdf::kMaxLobes && bytes_of(lobes) < least_bytes_; lobes += 1 + lobes / 5) {
      if (enough(growth, lobes) || tried_lobes_ < lobes) return;
    }
  }

  /// Whether a fit of at most `lobes` makes pictures as good as the full model's; if so, it becomes the best so far.
  bool enough(LobeGrowth& growth, int lobes) {
    GrowthResult fit = growth.fit(lobes);
    tried_lobes_ = fit.brdf.lobe_count();
    judge_.refine_colors(fit.brdf);
    if (limit_) limit_albedo(fit.brdf, growth_options_.threads, progress_);
    // Excess error over the full model, hit by hit, so that the common part and its noise cancel.
    std::vector<double> excess = judge_.shares(fit.brdf);
    for (size_t i = 0; i < excess.size(); ++i) excess[i] -= (1 + kSlack) * full_shares_[i];
    const PictureErrorEstimate worse = PictureError::estimate(excess);
    if (!(worse.relmse + kSure * worse.standard_error <= kUnseen)) return false;
    least_bytes_ = fit.brdf.parameter_bytes();
    best_ = std::move(fit);
    return true;
  }

  const std::vector<MeasuredSlice>& slices_;
  GrowthOptions growth_options_;
  bool limit_;  // limit the albedo
  const PictureError& judge_;
  Progress& progress_;
  std::vector<double> full_shares_;
  uint64_t least_bytes_;
  int tried_lobes_ = 0;  // lobes of the last fit
  std::optional<GrowthResult> best_;
};

Model full_model(const Measurement& measurement, FitOptions options, Progress& progress) {
  if (options.full_model) return *options.full_model;
  options.for_scene = nullptr;
  return fit_parametric(measurement, options, progress, kFullShare);
}

SceneObservation checked(const Measurement& measurement, const FitOptions& options) {
  if (!measurement.isotropic()) {
    throw Error(Status::unsupported, "'" + measurement.provenance().path +
                                         "' is anisotropic. A scene usage contains only the polar angles of the views, "
                                         "so only isotropic measurements can be reduced to it. Fit without a scene.");
  }
  if (!options.for_scene->hits.empty()) return reflected_part(*options.for_scene);
  throw Error(Status::invalid_argument,
              "The scene does not show the material: no camera ray hits it. Check camera, visibility and frames, or "
              "fit without a scene.");
}

const ParametricBrdf& parametric_body(const Model& model) {
  if (const auto* brdf = std::get_if<ParametricBrdf>(&model.body); brdf && !is_reduced(model)) return *brdf;
  throw Error(
      Status::invalid_argument,
      "The full model for a scene model must be a parametric model that is not reduced to a scene; this one is " +
          std::string(is_reduced(model) ? "itself a scene model" : model_kind(model)) + ".");
}

}  // namespace

Model fit_for_scene(const Measurement& measurement, const FitOptions& options, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  const SceneObservation observation = checked(measurement, options);
  const Model full = full_model(measurement, options, progress);
  const ParametricBrdf& full_brdf = parametric_body(full);
  const double begin = options.full_model ? 0 : kFullShare;
  progress.stage("reading the scene usage", begin, begin + kReadingShare);
  const ViewRange range = view_range(observation.domain);
  const MeasuredSlices measured = parametric_slices(measurement, options, progress);
  const std::vector<MeasuredSlice> slices = seen_slices(measured.slices, range, observation);
  const PictureError judge(measurement, full_brdf, observation, options.threads, progress);
  GrowthOptions growth_options = growth_options_of(measurement, options);
  growth_options.views = range;
  SceneSearch search(slices, growth_options, options.limit_albedo, judge, full_brdf, progress);
  search.run(begin + kReadingShare, 0.95);

  progress.stage("checking the model", 0.95, 1.0);
  Model model = full;
  if (search.best()) {
    judge_again(slices, growth_options, *search.best(), progress);  // colors have changed
    model = parametric_model(measurement, *search.best(), options, progress);
    model.shell = full.shell;
  } else {
    model.fit.warnings.push_back(warning<WarningCode::scene_needs_full_model>());
  }
  const auto error = [](const std::vector<double>& shares) { return PictureError::estimate(shares).relmse; };
  model.scene =
      SceneRecord{observation.domain, std::max(0.0, error(judge.shares(std::get<ParametricBrdf>(model.body)))),
                  std::max(0.0, error(search.full_shares())), full_brdf.parameter_bytes()};
  progress.update(1.0);
  model.fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return model;
}

namespace {

constexpr double kMinImportance = 0.1, kMaxImportance = 10;
// Minimum divisor, so that the radiance of light at grazing incidence, which contributes little, is not overrated.
constexpr float kMinLightCosine = 0.05f;

}  // namespace

LightImportance::LightImportance(const SceneObservation& observation)
    : value_(static_cast<size_t>(kRings * kSpokes), 0.0) {
  for (const ObservedHit& hit : observation.hits) {
    for (uint32_t i = hit.first; i < hit.last; ++i) {
      const Vec3& wl = observation.wl[i];
      value_[bin(hit.wv, wl)] += static_cast<double>(luminance(observation.light[i]) / std::max(wl.z, kMinLightCosine));
    }
  }
  const double mean = std::accumulate(value_.begin(), value_.end(), 0.0) / static_cast<double>(value_.size());
  for (double& v : value_) v = mean > 0 ? std::clamp(v / mean, kMinImportance, kMaxImportance) : 1;
}

size_t LightImportance::bin(const Vec3& wv, const Vec3& wl) {
  const auto azimuth = [](const Vec3& w) { return std::atan2(static_cast<double>(w.y), static_cast<double>(w.x)); };
  const double phi = std::abs(std::remainder(azimuth(wl) - azimuth(wv), 2 * kPiD));
  const int ring = std::clamp(static_cast<int>(wl.z * kRings), 0, kRings - 1);
  const int spoke = std::clamp(static_cast<int>(phi / kPiD * kSpokes), 0, kSpokes - 1);
  return static_cast<size_t>(ring * kSpokes + spoke);
}

}  // namespace velour

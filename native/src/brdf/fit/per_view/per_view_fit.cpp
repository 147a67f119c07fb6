#include "brdf/fit/per_view/per_view_fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "brdf/eval/per_view_material.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/fit_input.h"
#include "brdf/fit/fit_report.h"
#include "brdf/fit/per_view/slice_fit.h"
#include "math/srbf/lobe_mixture.h"

namespace velour {

namespace {

constexpr uint64_t kLobeBytes = PerViewBrdf::kLobeBytes, kViewBytes = PerViewBrdf::kViewBytes;

double relative_l2(const Material& material, const MeasuredSlice& slice) {
  std::vector<Vec3> wl;
  for (const SliceSample& s : slice.samples) wl.push_back(s.wl);
  std::vector<Rgb> f(wl.size());
  evaluate(material, slice.wv, wl, f);
  double error = 0, energy = 0;
  for (size_t i = 0; i < wl.size(); ++i) {
    const SliceSample& s = slice.samples[i];
    const double measured = luminance(s.value), difference = luminance(f[i]) * s.wl.z - measured;
    error += s.weight * difference * difference;
    energy += s.weight * measured * measured;
  }
  if (energy > 0) return std::sqrt(error / energy);
  return error > 0 ? 1 : 0;  // a black slice
}

/// Numbers of views to try, each two thirds of the previous one.
std::vector<size_t> view_counts(size_t views, uint64_t max_bytes) {
  std::vector<size_t> counts;
  for (size_t n = views; n >= 1; n = std::min(n - 1, n * 2 / 3)) {
    if (n * kViewBytes <= max_bytes) counts.push_back(n);
  }
  return counts;
}

FittedSlices thinned_to(size_t views, uint64_t max_bytes, const FittedSlices& all) {
  FittedSlices kept;
  for (const size_t i : thinned(all.paths.size(), views)) {
    kept.slices.push_back(all.slices[i]);
    kept.paths.push_back(all.paths[i]);
  }
  const auto share = share_lobes(kept.paths, (max_bytes - kViewBytes * views) / kLobeBytes);
  for (size_t i = 0; i < views; ++i) kept.paths[i].path.resize(share[i] + 1);
  return kept;
}

}  // namespace

uint64_t parameter_bytes(const FittedSlices& fitted) {
  uint64_t lobes = 0;
  for (const ViewPath& p : fitted.paths) lobes += p.path.size() - 1;
  return lobes * kLobeBytes + fitted.paths.size() * kViewBytes;
}

std::shared_ptr<PerViewBrdf> assemble(const FittedSlices& fitted, bool isotropic, const FitOptions& options) {
  auto brdf = std::make_shared<PerViewBrdf>();
  brdf->kernel = options.kernel;
  brdf->isotropic = isotropic;
  brdf->align_views = options.align_views;
  brdf->default_neighbors = PerViewBrdf::usual_neighbors(isotropic);
  brdf->first_lobe.push_back(0);
  for (size_t i = 0; i < fitted.slices.size(); ++i) {
    const SliceFit& fit = fitted.paths[i].path.back();
    brdf->views.push_back(fitted.slices[i].wv);
    brdf->diffuse.emplace_back(fit.diffuse);
    for (const SliceLobe& lobe : fit.lobes) {
      const StoredLobe stored = stored_lobe(options.kernel, lobe);
      brdf->center.push_back(stored.center);
      brdf->bandwidth.push_back(stored.bandwidth);
      brdf->coefficient.push_back(stored.coefficient);
    }
    brdf->first_lobe.push_back(static_cast<uint32_t>(brdf->center.size()));
  }
  return brdf;
}

double error_over_slices(std::shared_ptr<const PerViewBrdf> brdf, const std::vector<MeasuredSlice>& slices) {
  const auto material = make_per_view_material(std::move(brdf), 0);
  double sum = 0, weights = 0;
  for (const MeasuredSlice& slice : slices) {
    sum += slice.wv.z * relative_l2(*material, slice);
    weights += slice.wv.z;
  }
  return sum / weights;
}

FittedSlices within(uint64_t max_bytes, const FittedSlices& all, bool isotropic, const FitOptions& options) {
  if (parameter_bytes(all) <= max_bytes) return all;
  FittedSlices best;
  double least = std::numeric_limits<double>::infinity();
  for (const size_t views : view_counts(all.slices.size(), max_bytes)) {
    FittedSlices candidate = thinned_to(views, max_bytes, all);
    const double error = error_over_slices(assemble(candidate, isotropic, options), all.slices);
    if (error < least) {
      least = error;
      best = std::move(candidate);
    }
  }
  return best;
}

namespace {

double cost(const ViewPath& view, size_t lobes) {
  const double e = view.path[lobes].relative_l2;
  return view.importance * e * e;
}

/// The best next saving of one view: the shorter prefix with the smallest rise of error per lobe (the convex hull of
/// the path, so that a flat stretch behind a steep one is found).
struct Saving {
  size_t to = 0;
  double rise_per_lobe = std::numeric_limits<double>::infinity();
};

Saving best_saving(const ViewPath& view, size_t from) {
  Saving best;
  for (size_t to = 0; to < from; ++to) {
    const double rise = (cost(view, to) - cost(view, from)) / static_cast<double>(from - to);
    if (rise < best.rise_per_lobe) best = {to, rise};
  }
  return best;
}

}  // namespace

std::vector<size_t> share_lobes(const std::vector<ViewPath>& views, uint64_t lobes) {
  std::vector<size_t> share;
  uint64_t used = 0;
  for (const ViewPath& v : views) {
    share.push_back(v.path.size() - 1);
    used += share.back();
  }
  while (used > lobes) {
    size_t cheapest = views.size();
    Saving best;
    for (size_t i = 0; i < views.size(); ++i) {
      const Saving saving = best_saving(views[i], share[i]);
      if (saving.rise_per_lobe < best.rise_per_lobe) best = saving, cheapest = i;
    }
    if (cheapest == views.size()) break;  // no lobes are left
    used -= share[cheapest] - best.to;
    share[cheapest] = best.to;
  }
  return share;
}

std::vector<size_t> thinned(size_t count, size_t keep) {
  std::vector<size_t> out;
  if (keep >= count) keep = count;
  for (size_t i = 0; i < keep; ++i) out.push_back(keep == 1 ? 0 : i * (count - 1) / (keep - 1));
  return out;
}

namespace {

// Slices are fitted more tightly than required, to leave room for the interpolation error between them.
constexpr double kSliceGoalShare = 0.8;
// Half vectors turn with the view, so the lobes of neighboring slices correspond.
constexpr SliceGrid kGrid{.parts = 0, .rings = 96, .spokes = 64};

std::vector<ViewPath> fit_slices(const std::vector<MeasuredSlice>& slices, const FitOptions& options,
                                 Progress& progress) {
  std::vector<ViewPath> paths(slices.size());
  parallel_for_each(slices.size(), options.threads, progress, [&](size_t i) {
    const double theta_v = std::acos(std::min(slices[i].wv.z, 1.0f));
    const SliceSamples samples(slices[i].samples);
    const double goal = std::hypot(kSliceGoalShare * tolerance_at(options.tolerance, theta_v), samples.gamut_error());
    paths[i] = {fit_slice(samples, {options.kernel, options.max_lobes, goal}, progress), slices[i].wv.z};
  });
  return paths;
}

/// The model of `fitted`, which is `all` or a part of it, with its record: errors, albedo, order, warnings.
Model reported(const Measurement& measurement, const FittedSlices& all, const FittedSlices& fitted,
               const FitOptions& options, Progress& progress) {
  const auto brdf = assemble(fitted, measurement.isotropic(), options);
  std::vector<FittedView> views;
  for (size_t i = 0; i < fitted.slices.size(); ++i) {
    views.push_back({fitted.slices[i].wv, fitted.paths[i].path.back().relative_l2});
  }
  Model model;
  model.fit = report_fit(measurement, *make_per_view_material(brdf, 0), options, views, {}, progress);
  model.fit.order = order_of_slices(all, fitted, options.tolerance);
  model.body = *brdf;
  model.source = {measurement.provenance().name, measurement.provenance().format, measurement.provenance().sha256};
  return model;
}

uint64_t size_of_per_view(const Model& model, const FitOptions& options) {
  return options.size_of ? options.size_of(model) : std::get<PerViewBrdf>(model.body).parameter_bytes();
}

/// Best model of `all` within options.max_bytes, in a few tries: its size is known only once it is encoded.
Model bounded_model(const Measurement& measurement, const FittedSlices& all, const FitOptions& options,
                    Progress& progress) {
  const uint64_t whole = parameter_bytes(all);
  for (uint64_t budget = std::max(PerViewBrdf::kViewBytes, std::min(options.max_bytes, whole));;) {
    progress.check();
    const FittedSlices fitted = within(budget, all, measurement.isotropic(), options);
    Model model = reported(measurement, all, fitted, options, progress);
    if (budget < whole) {
      model.fit.warnings.push_back(
          warning<WarningCode::model_bounded>({{"bytes", options.max_bytes},
                                               {"views", fitted.slices.size()},
                                               {"lobes", std::get<PerViewBrdf>(model.body).center.size()}}));
    }
    const uint64_t size = size_of_per_view(model, options);
    if (size <= options.max_bytes) return model;
    if (budget == PerViewBrdf::kViewBytes) {
      throw Error(Status::invalid_argument, "The fit's max_bytes is " + std::to_string(options.max_bytes) +
                                                ", but the smallest model of this measurement takes " +
                                                std::to_string(size) + " bytes. Raise the maximum size.");
    }
    const uint64_t excess = size - options.max_bytes + PerViewBrdf::kLobeBytes;
    budget = budget > excess + PerViewBrdf::kViewBytes ? budget - excess : PerViewBrdf::kViewBytes;
  }
}

}  // namespace

Model fit_per_view(const Measurement& measurement, const FitOptions& options, Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  check_options(options, LobeMixture::kCapacity / PerViewBrdf::usual_neighbors(measurement.isotropic()));
  progress.stage("sampling", 0.0, 0.1);
  MeasuredSlices measured = read_slices(measurement, kGrid, options, progress);
  std::vector<Warning> warnings;
  warn_of_slices(measured, warnings);
  progress.stage("fitting", 0.1, 0.95);
  auto paths = fit_slices(measured.slices, options, progress);
  const FittedSlices fitted{std::move(measured.slices), std::move(paths)};

  progress.stage("checking the model", 0.95, 1.0);
  Model model = options.max_bytes > 0 ? bounded_model(measurement, fitted, options, progress)
                                      : reported(measurement, fitted, fitted, options, progress);
  model.fit.warnings.insert(model.fit.warnings.end(), warnings.begin(), warnings.end());
  progress.check();
  progress.update(1.0);
  model.fit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return model;
}

namespace {

size_t most_lobes(const FittedSlices& fitted) {
  size_t most = 0;
  for (const ViewPath& p : fitted.paths) most = std::max(most, p.path.size() - 1);
  return most;
}

/// The point of `fitted` with at most `lobes` lobes per view.
OrderPoint point_at(const FittedSlices& fitted, size_t lobes, double tolerance) {
  OrderPoint point{static_cast<int>(lobes), 0, 0, 0};
  double sum = 0, weights = 0;
  for (size_t i = 0; i < fitted.paths.size(); ++i) {
    const ViewPath& view = fitted.paths[i];
    const size_t kept = std::min(lobes, view.path.size() - 1);
    const double error = view.path[kept].relative_l2;
    const double theta_v = std::acos(std::min(fitted.slices[i].wv.z, 1.0f));
    point.parameter_bytes += PerViewBrdf::kViewBytes + kept * PerViewBrdf::kLobeBytes;
    point.worst = std::max(point.worst, error / tolerance_at(tolerance, theta_v));
    sum += view.importance * error;
    weights += view.importance;
  }
  if (weights > 0) point.relative_l2 = sum / weights;
  return point;
}

}  // namespace

OrderCurve order_of_slices(const FittedSlices& all, const FittedSlices& chosen, double tolerance) {
  OrderCurve order;
  const size_t most = most_lobes(all);
  for (size_t lobes = 1; lobes < most; lobes *= 2) order.points.push_back(point_at(all, lobes, tolerance));
  order.points.push_back(point_at(all, most, tolerance));
  const OrderPoint model = point_at(chosen, most_lobes(chosen), tolerance);
  const auto smaller = [](const OrderPoint& a, const OrderPoint& b) { return a.parameter_bytes < b.parameter_bytes; };
  auto at = std::lower_bound(order.points.begin(), order.points.end(), model, smaller);
  if (at == order.points.end() || *at != model) at = order.points.insert(at, model);
  order.chosen = static_cast<size_t>(at - order.points.begin());
  return order;
}

}  // namespace velour

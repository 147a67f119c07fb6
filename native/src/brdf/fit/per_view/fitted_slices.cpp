#include "brdf/fit/per_view/fitted_slices.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include "brdf/eval/per_view_material.h"
#include "brdf/fit/error/evaluate.h"
#include "brdf/fit/per_view/slice_fit.h"

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

}  // namespace velour

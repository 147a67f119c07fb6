#include "brdf/fit/fit_input.h"

#include <algorithm>
#include <cmath>
#include <map>
#include "brdf/fit/slice_sampling.h"
#include "brdf/measure/held_out.h"

namespace velour {

namespace {

void warn_of_uncovered(size_t uncovered, size_t fitted, std::vector<Warning>& warnings) {
  if (uncovered == 0) return;
  warnings.push_back(warning<WarningCode::views_left_out>({{"uncovered", uncovered}, {"sampled", uncovered + fitted}}));
}

void warn_of_gamut(const std::vector<MeasuredSlice>& slices, std::vector<Warning>& warnings) {
  size_t total = 0, outside = 0;
  double cost = 0;
  for (const MeasuredSlice& s : slices) {
    total += s.samples.size();
    outside += s.out_of_gamut;
    cost = std::max(cost, SliceSamples(s.samples).gamut_error());
  }
  if (outside == 0) return;
  warnings.push_back(warning<WarningCode::out_of_gamut>({{"outside", outside}, {"values", total}, {"error", cost}}));
}

/// Views are left out if they have too few valid lights (sample_slices) or are not covered (covers_view).
[[noreturn]] void refuse_uncovered(const Measurement& measurement) {
  const EntryCounts& n = measurement.counts();
  const std::string negative = n.negative > 0 ? ", " + std::to_string(n.negative) + " are negative" : "";
  throw Error(Status::bad_data, "'" + measurement.provenance().path +
                                    "' covers less than half of the light directions at every view, so it cannot be "
                                    "fitted (" +
                                    std::to_string(n.valid) + " of " + std::to_string(n.valid + n.invalid()) +
                                    " entries are valid" + negative +
                                    "). Measure more directions, or check how the file marks missing values.");
}

}  // namespace

void check_options(const FitOptions& o, int most_lobes) {
  const auto refuse = [](const std::string& sentence) { throw Error(Status::invalid_argument, sentence); };
  if (!(o.tolerance > 0 && o.tolerance <= 1)) {
    refuse("The fit's tolerance is " + std::to_string(o.tolerance) + "; it must be above 0 and at most 1.");
  }
  if (o.max_lobes < 1 || o.max_lobes > most_lobes) {
    refuse("The fit's max_lobes is " + std::to_string(o.max_lobes) + "; it must be 1 to " + std::to_string(most_lobes) +
           " for this measurement.");
  }
  if (o.threads < 0)
    refuse("The fit's number of threads is " + std::to_string(o.threads) + "; it must be at least 0 (0: all).");
}

MeasuredSlices read_slices(const Measurement& measurement, const SliceGrid& grid, const FitOptions& options,
                           Progress& progress) {
  const auto unseen = options.all_data ? nullptr : measurement.without_held_out(progress);
  const Measurement& source = unseen ? *unseen : measurement;
  MeasuredSlices slices = sample_slices(source, grid, !options.all_data && !unseen, options.threads, progress);
  if (slices.slices.empty()) refuse_uncovered(measurement);
  if (grid.folded && !source.samples().empty()) {
    for (MeasuredSlice& slice : slices.slices) slice.interpolated = true;
    for (MeasuredSlice& slice : bin_samples(source.samples())) slices.slices.push_back(std::move(slice));
  }
  return slices;
}

void warn_of_slices(const MeasuredSlices& slices, std::vector<Warning>& warnings) {
  warn_of_uncovered(slices.uncovered.size(), slices.slices.size(), warnings);
  warn_of_gamut(slices.slices, warnings);
}

namespace {

constexpr double kBin = 1.0;  // degrees

/// The pair rotated about the normal so that wv lies on the meridian, with wl mirrored to y >= 0.
DirectionPair canonical(const Vec3& wl, const Vec3& wv) {
  const double azimuth = std::atan2(static_cast<double>(wv.y), static_cast<double>(wv.x));
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  const Vec3d l(c * wl.x + s * wl.y, std::abs(c * wl.y - s * wl.x), wl.z);
  return {Vec3(l), Vec3(static_cast<float>(std::hypot(wv.x, wv.y)), 0, wv.z)};
}

void add_sample(const IrregularSample& sample, const Vec3& wl, const Vec3& wv, std::map<int, MeasuredSlice>& bins) {
  const DirectionPair pair = canonical(wl, wv);
  const double degrees = std::atan2(pair.wv.x, pair.wv.z) * 180 / kPiD;
  const int bin = static_cast<int>(std::lround(degrees / kBin));
  const Vec3 view = direction(static_cast<float>(radians_from(bin * kBin)), 0.0f);
  const Vec3d h = glm::normalize(Vec3d(pair.wl) + Vec3d(pair.wv));
  const Vec3d light = 2 * glm::dot(h, Vec3d(view)) * h - Vec3d(view);
  if (!(light.z > 0) || view.z <= 0) return;
  MeasuredSlice& slice = bins[bin];
  slice.wv = view;
  slice.samples.push_back({Vec3(glm::normalize(light)), 1.0f, sample.f * static_cast<float>(light.z)});
  slice.out_of_gamut += std::min({sample.f.r, sample.f.g, sample.f.b}) < 0;
}

double luminance_energy(const MeasuredSlice& slice) {
  double sum = 0;
  for (const SliceSample& s : slice.samples) sum += static_cast<double>(luminance(s.value)) * luminance(s.value);
  return sum;
}

}  // namespace

std::vector<MeasuredSlice> bin_samples(std::span<const IrregularSample> samples) {
  std::map<int, MeasuredSlice> bins;
  for (const IrregularSample& s : samples) {
    add_sample(s, s.wl, s.wv, bins);
    add_sample(s, s.wv, s.wl, bins);
  }
  std::vector<MeasuredSlice> out;
  for (auto& [bin, slice] : bins) {
    for (const auto& [other, near] : bins) {
      if (std::abs(other - bin) * kBin <= kHeldOutGroup) slice.energy += luminance_energy(near);
    }
    out.push_back(slice);
  }
  return out;
}

}  // namespace velour

#include "fit/fit_input.h"

#include <algorithm>

#include "fit/sample_bins.h"
#include "fit/slice_samples.h"

namespace velour {
namespace {

void warn_of_uncovered(size_t uncovered, size_t fitted, std::vector<std::string>& warnings) {
  if (uncovered == 0) return;
  warnings.push_back(std::to_string(uncovered) + " of " + std::to_string(uncovered + fitted) +
                     " sampled views are outside the measurement and were left out");
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
                     " fitted values have a negative channel (a color outside Rec. 709), which non-negative "
                     "coefficients cannot represent; this alone causes a relative L2 error of up to " +
                     std::to_string(cost));
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
  if (slices.slices.empty()) {
    const EntryCounts& n = measurement.counts();
    throw Error(Status::bad_data, "'" + measurement.provenance().path +
                                      "' has no view direction with at least 8 valid light directions (" +
                                      std::to_string(n.valid) + " of " + std::to_string(n.valid + n.invalid()) +
                                      " entries are valid), so it cannot be fitted. Measure more directions, or check "
                                      "how the file marks missing values.");
  }
  if (grid.folded && !source.samples().empty()) {
    for (MeasuredSlice& slice : slices.slices) slice.interpolated = true;
    for (MeasuredSlice& slice : bin_samples(source.samples())) slices.slices.push_back(std::move(slice));
  }
  return slices;
}

void warn_of_slices(const MeasuredSlices& slices, std::vector<std::string>& warnings) {
  warn_of_uncovered(slices.uncovered.size(), slices.slices.size(), warnings);
  warn_of_gamut(slices.slices, warnings);
}

}  // namespace velour

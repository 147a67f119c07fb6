#include "fit/slice_sampling.h"

#include <algorithm>
#include <cmath>

#include "brdf/held_out.h"
#include "fit/parallel.h"
#include "fit/view_grid.h"

namespace velour {
namespace {

// Fewer samples than this leave a lobe's four unknowns undetermined.
constexpr size_t kLeastSamples = 8;

// Squares of more would not fit a float, and a model file holds no larger coefficients.
constexpr float kLargestValue = 1e12f;

bool usable(const Rgb& f) { return std::isfinite(f.r) && std::isfinite(f.g) && std::isfinite(f.b); }

void check_size(const Measurement& source, const Rgb& f) {
  const float largest = std::max({std::abs(f.r), std::abs(f.g), std::abs(f.b)});
  if (largest <= kLargestValue) return;
  throw Error(Status::bad_data, "'" + source.provenance().path + "' holds the value " + std::to_string(largest) +
                                    " 1/sr; values up to 1e12 can be fitted. Check the measurement's scale.");
}

MeasuredSlice sample_slice(const Measurement& source, const Vec3& wv, bool hold_out) {
  LightGrid grid = light_grid(wv);
  const size_t n = grid.wl.size();
  std::vector<uint8_t> kept(n, 1), valid(n, 0);
  if (hold_out) {
    for (size_t i = 0; i < n; ++i) kept[i] = !held_out_light(i);
    redistribute_weights(grid, kept);
  }
  std::vector<Rgb> f(n, Rgb(0));
  source.eval(wv, grid.wl, f, valid);
  MeasuredSlice slice{wv, {}, 0};
  for (size_t i = 0; i < n; ++i) {
    if (!kept[i] || !valid[i] || !usable(f[i])) continue;
    check_size(source, f[i]);
    slice.samples.push_back({grid.wl[i], grid.weight[i], f[i] * grid.wl[i].z});
    slice.out_of_gamut += std::min({f[i].r, f[i].g, f[i].b}) < 0;
  }
  return slice;
}

}  // namespace

MeasuredSlices sample_slices(const Measurement& source, bool hold_out, int threads, Progress& progress) {
  const std::vector<Vec3> views = source.isotropic() ? meridian_views(!hold_out) : hemisphere_views(!hold_out);
  std::vector<MeasuredSlice> all(views.size());
  parallel_for_each(views.size(), threads, progress, [&](size_t i) {
    if (source.covers_view(std::acos(std::clamp(views[i].z, -1.0f, 1.0f)))) {
      all[i] = sample_slice(source, views[i], hold_out);
    }
  });
  MeasuredSlices out;
  for (size_t i = 0; i < views.size(); ++i) {
    if (all[i].samples.size() >= kLeastSamples)
      out.slices.push_back(std::move(all[i]));
    else
      out.uncovered.push_back(views[i]);
  }
  return out;
}

}  // namespace velour

#include "brdf/fit/slice_sampling.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/parallel.h"
#include "brdf/fit/view_grid.h"
#include "brdf/measure/held_out.h"

namespace velour {
namespace {

// Fewer samples than this leave a lobe's four unknowns undetermined.
constexpr size_t kMinSamples = 8;

// Maximum value: keeps squares within the range of float; a model file holds no larger coefficients.
constexpr float kLargestValue = 1e12f;

void check_size(const Measurement& source, const Rgb& f) {
  const float largest = std::max({std::abs(f.r), std::abs(f.g), std::abs(f.b)});
  if (largest <= kLargestValue) return;
  throw Error(Status::bad_data, "'" + source.provenance().path + "' contains the value " + std::to_string(largest) +
                                    " 1/sr; values up to 1e12 can be fitted. Check the scale of the measurement.");
}

void keep_one_side(LightGrid& grid) {
  LightGrid half;
  for (size_t i = 0; i < grid.wl.size(); ++i) {
    if (grid.wl[i].y < 0) continue;
    half.wl.push_back(grid.wl[i]);
    half.weight.push_back(2 * grid.weight[i]);
    half.ring.push_back(grid.ring[i]);
  }
  grid = std::move(half);
}

using Image = std::function<Vec3(const Vec3&)>;

/// The mean over `images` of each of `wl`, where valid.
void read_mean(const LightReader& read, std::span<const Image> images, std::span<const Vec3> wl,
               std::span<LightValue> values) {
  std::vector<double> count(wl.size(), 0), square(wl.size(), 0);
  std::vector<Vec3d> sum(wl.size(), Vec3d(0));
  std::vector<Vec3> moved(wl.size());
  std::vector<LightValue> found(wl.size());
  for (const auto& image : images) {
    std::ranges::transform(wl, moved.begin(), image);
    std::ranges::fill(found, LightValue());
    read(moved, found);
    for (size_t i = 0; i < wl.size(); ++i) {
      if (!found[i].valid) continue;
      const double y = luminance(found[i].f);
      sum[i] += Vec3d(found[i].f);
      square[i] += y * y;
      count[i] += 1;
    }
  }
  for (size_t i = 0; i < wl.size(); ++i) {
    if (count[i] == 0) continue;
    const Rgb mean(sum[i] / count[i]);
    const double y = luminance(mean);
    values[i] = {.f = mean, .spread = static_cast<float>(std::max(square[i] / count[i] - y * y, 0.0)), .valid = true};
  }
}

/// Means over the lights that are equivalent for an isotropic surface and a view on the meridian.
LightReader folded(LightReader read, const Vec3& wv) {
  std::vector<Image> images;
  if (wv.x == 0) {  // along the normal, f depends on theta_l alone
    constexpr int kTurns = 8;
    for (int k = 0; k < kTurns; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k) / kTurns, c = std::cos(angle), s = std::sin(angle);
      images.emplace_back([c, s](const Vec3& w) { return Vec3(c * w.x - s * w.y, s * w.x + c * w.y, w.z); });
    }
  } else {
    images.emplace_back([](const Vec3& w) { return w; });
    images.emplace_back([](const Vec3& w) { return Vec3(w.x, -w.y, w.z); });
  }
  return [read = std::move(read), images = std::move(images)](std::span<const Vec3> wl, std::span<LightValue> values) {
    read_mean(read, images, wl, values);
  };
}

/// The lights of a view and their values. A ring of a tree is a run of neighboring leaves.
struct MeasuredLights {
  LightGrid grid;
  std::vector<LightValue> values;
  std::shared_ptr<const DirectionTree> tree;  // of tables
};

MeasuredLights measured_lights(const Measurement& source, const Vec3& wv, const SliceGrid& size) {
  constexpr uint32_t kRun = 16;
  const LightReader read = size.folded ? folded(reader_of(source, wv), wv) : reader_of(source, wv);
  MeasuredLights out;
  if (size.parts == 0 || !source.samples().empty()) {
    out.grid = light_grid(wv, size.rings, size.spokes);
    if (size.folded) keep_one_side(out.grid);
    out.values.resize(out.grid.wl.size());
    read(out.grid.wl, out.values);
    return out;
  }
  out.tree = std::make_shared<const DirectionTree>(read, wv, size.parts, size.folded);
  const auto sides = size.folded ? 2.0f : 1.0f;
  for (const uint32_t leaf : out.tree->leaves()) {
    const DirectionTree::Cell& cell = out.tree->cell(leaf);
    out.grid.ring.push_back(static_cast<uint32_t>(out.grid.wl.size()) / kRun);
    out.grid.wl.push_back(cell.wl);
    out.grid.weight.push_back(sides * static_cast<float>(cell.solid_angle()));
    out.values.push_back(cell.value);
  }
  return out;
}

/// Relative L2 difference between the measured values and their means.
double fold_of(const MeasuredLights& lights) {
  double hidden = 0, energy = 0;
  for (size_t i = 0; i < lights.values.size(); ++i) {
    const LightValue& value = lights.values[i];
    if (!value.valid) continue;
    const double y = luminance(value.f), cosine = lights.grid.wl[i].z;
    const double weight = static_cast<double>(lights.grid.weight[i]) * cosine * cosine, spread = value.spread;
    hidden += weight * spread;
    energy += weight * (y * y + spread);
  }
  return energy > 0 ? std::sqrt(hidden / energy) : 0;
}

/// Takes the samples in steps, so that every block of SliceSamples::kPadding covers the whole view: the search for
/// lobes reads some of the blocks only (brdf/fit/parametric/lobe_search.h).
std::vector<SliceSample> interleaved(const std::vector<SliceSample>& samples) {
  const size_t step = (samples.size() + SliceSamples::kPadding - 1) / SliceSamples::kPadding;
  std::vector<SliceSample> out;
  for (size_t first = 0; first < step; ++first) {
    for (size_t i = first; i < samples.size(); i += step) out.push_back(samples[i]);
  }
  return out;
}

MeasuredSlice sample_slice(const Measurement& source, const Vec3& wv, const SliceGrid& size, bool hold_out) {
  MeasuredLights lights = measured_lights(source, wv, size);
  const size_t n = lights.grid.wl.size();
  std::vector<uint8_t> kept(n, 1);
  if (hold_out) {
    for (size_t i = 0; i < n; ++i) kept[i] = !held_out_light(i);
    redistribute_weights(lights.grid, kept);
  }
  MeasuredSlice slice{.wv = wv, .samples = {}, .lights = lights.tree};
  if (size.folded) slice.fold = fold_of(lights);
  for (size_t i = 0; i < n; ++i) {
    if (!kept[i] || !lights.values[i].valid) continue;
    const Rgb& f = lights.values[i].f;
    check_size(source, f);
    slice.samples.push_back({lights.grid.wl[i], lights.grid.weight[i], f * lights.grid.wl[i].z});
    slice.out_of_gamut += std::min({f.r, f.g, f.b}) < 0;
  }
  if (lights.tree) slice.samples = interleaved(slice.samples);
  return slice;
}

}  // namespace

MeasuredSlices sample_slices(const Measurement& source, const SliceGrid& grid, bool hold_out, int threads,
                             Progress& progress) {
  const std::vector<Vec3> views = source.isotropic() ? meridian_views(!hold_out) : hemisphere_views(!hold_out);
  std::vector<MeasuredSlice> all(views.size());
  parallel_for_each(views.size(), threads, progress, [&](size_t i) {
    if (source.covers_view(std::acos(std::clamp(views[i].z, -1.0f, 1.0f)))) {
      all[i] = sample_slice(source, views[i], grid, hold_out);
    }
  });
  MeasuredSlices out;
  for (size_t i = 0; i < views.size(); ++i) {
    if (all[i].samples.size() >= kMinSamples)
      out.slices.push_back(std::move(all[i]));
    else
      out.uncovered.push_back(views[i]);
  }
  return out;
}

}  // namespace velour

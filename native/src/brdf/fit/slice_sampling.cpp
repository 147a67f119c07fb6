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

bool usable(const Rgb& f) { return std::isfinite(f.r) && std::isfinite(f.g) && std::isfinite(f.b); }

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

/// Measured f of lights and of their mirror images.
struct MirrorPairs {
  std::vector<Rgb> f, image;
  std::vector<uint8_t> valid, image_valid;
};

/// f of `lights` for a view on the meridian: the mean of the light and its mirror image, where valid.
MirrorPairs eval_folded(const Measurement& source, const Vec3& wv, const std::vector<Vec3>& lights, std::vector<Rgb>& f,
                        std::vector<uint8_t>& valid) {
  std::vector<Vec3> mirrored = lights;
  for (Vec3& wl : mirrored) wl.y = -wl.y;
  const std::vector<Rgb> nothing(f.size(), Rgb(0));
  const std::vector<uint8_t> none(f.size(), 0);
  MirrorPairs measured{nothing, nothing, none, none};
  source.eval(wv, lights, measured.f, measured.valid);
  source.eval(wv, mirrored, measured.image, measured.image_valid);
  for (size_t i = 0; i < f.size(); ++i) {
    measured.valid[i] &= usable(measured.f[i]);
    measured.image_valid[i] &= usable(measured.image[i]);
    valid[i] = measured.valid[i] | measured.image_valid[i];
    if (measured.valid[i]) f[i] = measured.f[i];
    if (measured.image_valid[i]) f[i] = measured.valid[i] ? 0.5f * (f[i] + measured.image[i]) : measured.image[i];
  }
  return measured;
}

/// Replaces f by the mean of its ring: for a view along the normal, where an isotropic f depends on theta_l alone.
void average_rings(const LightGrid& grid, std::vector<Rgb>& f, std::span<const uint8_t> valid) {
  for (size_t begin = 0, end = 0; begin < f.size(); begin = end) {
    Vec3d sum(0);
    size_t count = 0;
    for (; end < f.size() && grid.ring[end] == grid.ring[begin]; ++end) {
      if (valid[end] && usable(f[end])) sum += Vec3d(f[end]), ++count;
    }
    for (size_t i = begin; i < end && count > 0; ++i) f[i] = Rgb(sum / static_cast<double>(count));
  }
}

/// Relative L2 difference between the measured and the folded `f`.
double fold_of(const LightGrid& grid, const MirrorPairs& measured, const std::vector<Rgb>& f) {
  double hidden = 0, energy = 0;
  const auto add = [&](size_t i, const Rgb& value) {
    const double y = luminance(value) * grid.wl[i].z, folded = luminance(f[i]) * grid.wl[i].z;
    hidden += static_cast<double>(grid.weight[i]) * (y - folded) * (y - folded);
    energy += static_cast<double>(grid.weight[i]) * y * y;
  };
  for (size_t i = 0; i < f.size(); ++i) {
    if (measured.valid[i]) add(i, measured.f[i]);
    if (measured.image_valid[i]) add(i, measured.image[i]);
  }
  return energy > 0 ? std::sqrt(hidden / energy) : 0;
}

/// Sum of weight x luminance(f cos)^2.
double energy_of(const Measurement& source, const Vec3& wv, const std::vector<Vec3>& wl,
                 const std::function<double(size_t)>& weight) {
  std::vector<Rgb> f(wl.size(), Rgb(0));
  std::vector<uint8_t> valid(wl.size(), 0);
  source.eval(wv, wl, f, valid);
  double sum = 0;
  for (size_t i = 0; i < wl.size(); ++i) {
    if (!valid[i] || !usable(f[i])) continue;
    const double value = static_cast<double>(luminance(f[i]) * wl[i].z);
    sum += weight(i) * value * value;
  }
  return sum;
}

/// Whether `grid` misjudges the energy about the view's own direction. False for irregular samples, whose interpolation
/// is slow and which are fitted directly.
bool hides_retro_reflection(const Measurement& source, const Vec3& wv, const LightGrid& grid) {
  constexpr double kHidden = 0.02;      // share of the view's energy
  constexpr float kNearNormal = 0.97f;  // cos(theta_v); above it the mirror direction, where the grid is fine, is close
  if (!source.samples().empty() || wv.z > kNearNormal) return false;
  const CloseRings rings = retro_rings(wv);
  std::vector<Vec3> close;
  rings.append(close);
  const auto near = [&](size_t i) { return rings.density(grid.wl[i]) > 0 ? static_cast<double>(grid.weight[i]) : 0.0; };
  const double all = energy_of(source, wv, grid.wl, [&](size_t i) { return static_cast<double>(grid.weight[i]); });
  const double seen = energy_of(source, wv, grid.wl, near);
  const double there = energy_of(source, wv, close, [&](size_t i) { return 1 / rings.density(close[i]); });
  return std::abs(there - seen) > kHidden * std::max(all, there);
}

MeasuredSlice sample_slice(const Measurement& source, const Vec3& wv, const SliceGrid& size, bool hold_out) {
  LightGrid grid = light_grid(wv, size.rings, size.spokes);
  if (hides_retro_reflection(source, wv, grid)) join_retro_rings(grid, wv, size.rings, size.spokes);
  if (size.folded) keep_one_side(grid);
  const size_t n = grid.wl.size();
  std::vector<uint8_t> kept(n, 1), valid(n, 0);
  if (hold_out) {
    for (size_t i = 0; i < n; ++i) kept[i] = !held_out_light(i);
    redistribute_weights(grid, kept);
  }
  std::vector<Rgb> f(n, Rgb(0));
  MeasuredSlice slice{.wv = wv, .samples = {}};
  if (size.folded) {
    const MirrorPairs measured = eval_folded(source, wv, grid.wl, f, valid);
    if (wv.x == 0) average_rings(grid, f, valid);
    slice.fold = fold_of(grid, measured, f);
  } else {
    source.eval(wv, grid.wl, f, valid);
  }
  for (size_t i = 0; i < n; ++i) {
    if (!kept[i] || !valid[i] || !usable(f[i])) continue;
    check_size(source, f[i]);
    slice.samples.push_back({grid.wl[i], grid.weight[i], f[i] * grid.wl[i].z});
    slice.out_of_gamut += std::min({f[i].r, f[i].g, f[i].b}) < 0;
  }
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

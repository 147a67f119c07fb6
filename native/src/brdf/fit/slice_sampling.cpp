#include "brdf/fit/slice_sampling.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/parallel.h"
#include "brdf/measure/held_out.h"
#include "math/sphere/directions.h"

namespace velour {

SliceSamples::SliceSamples(std::span<const SliceSample> samples) : count_(samples.size()) {
  const size_t padded = (count_ + kPadding - 1) / kPadding * kPadding;
  for (AlignedFloats* a : {&x_, &y_, &sqrt_weight_, &target_[0], &target_[1], &target_[2]}) a->assign(padded, 0.0f);
  z_.assign(padded, 1.0f);  // padding has unit length, so that no kernel divides by 0
  for (size_t i = 0; i < count_; ++i) {
    const SliceSample& s = samples[i];
    x_[i] = s.wl.x;
    y_[i] = s.wl.y;
    z_[i] = s.wl.z;
    sqrt_weight_[i] = std::sqrt(s.weight);
    for (int c = 0; c < 3; ++c) {
      target_[c][i] = sqrt_weight_[i] * s.value[c];
      energy_[c] += static_cast<double>(target_[c][i]) * target_[c][i];
    }
    const double y = luminance(s.value);
    luminance_energy_ += s.weight * y * y;
    const double clamped = luminance(glm::max(s.value, Rgb(0))) - y;
    gamut_error_sq_ += s.weight * clamped * clamped;
  }
}

void SliceSamples::scale_weights(std::span<const float> factors) {
  for (size_t i = 0; i < count_; ++i) {
    const float root = std::sqrt(factors[i]);
    sqrt_weight_[i] *= root;
    for (AlignedFloats& target : target_) target[i] *= root;
  }
}

double SliceSamples::gamut_error() const {
  return luminance_energy_ > 0 ? std::sqrt(gamut_error_sq_ / luminance_energy_) : 0.0;
}

namespace {

constexpr double kMeridianStep = 2.0, kMeridianEnd = 89.0;  // degrees
constexpr int kHemisphereViews = 400;                       // a spacing of about 7 degrees
// Slightly more than the margin, so that rounding does not bring a view inside.
constexpr double kSafeMargin = kHeldOutMargin + 0.05;

/// `theta` (degrees), moved to the nearer edge of the margin if a held-out view is too close.
double outside_margins(double theta) {
  for (const int held_out : kHeldOutViews) {
    const double away = theta - held_out;
    if (std::abs(away) < kSafeMargin) return held_out + (away < 0 ? -kSafeMargin : kSafeMargin);
  }
  return theta;
}

/// theta_h where ring i of a light grid begins.
double ring_edge(int i, int rings) { return 0.5 * kPiD * i * i / (rings * rings); }

/// Solid angle of half vectors of one cell of ring i.
double half_vector_cell(int i, int rings, int spokes) {
  const double begin = ring_edge(i, rings), end = ring_edge(i + 1, rings);
  return 2 * std::sin(0.5 * (begin + end)) * std::sin(0.5 * (end - begin)) * 2 * kPiD / spokes;
}

}  // namespace

std::vector<Vec3> meridian_views(bool all_data) {
  std::vector<double> theta{0};
  const auto go_to = [&theta](double end) {
    const double begin = theta.back();
    const int steps = std::max(1, static_cast<int>(std::ceil((end - begin) / kMeridianStep)));
    for (int k = 1; k <= steps; ++k) theta.push_back(begin + (end - begin) * k / steps);
  };
  for (const int held_out : kHeldOutViews) {
    go_to(all_data ? held_out : held_out - kSafeMargin);
    if (!all_data) theta.push_back(held_out + kSafeMargin);  // one step over the gap
  }
  go_to(kMeridianEnd);
  std::vector<Vec3> views;
  for (const double t : theta) views.push_back(direction(static_cast<float>(radians_from(t)), 0.0f));
  return views;
}

std::vector<Vec3> hemisphere_views(bool all_data) {
  std::vector<Vec3> views = hemisphere_fibonacci(kHemisphereViews);
  if (all_data) return views;
  for (Vec3& v : views) {
    const double theta = std::acos(std::clamp(static_cast<double>(v.z), -1.0, 1.0)) * 180 / kPiD;
    v = direction(static_cast<float>(radians_from(outside_margins(theta))), std::atan2(v.y, v.x));
  }
  return views;
}

LightGrid light_grid(const Vec3& wv, int rings, int spokes) {
  LightGrid grid;
  const double azimuth = std::atan2(static_cast<double>(wv.y), static_cast<double>(wv.x));
  for (int i = 0; i < rings; ++i) {
    const double cell = half_vector_cell(i, rings, spokes),
                 theta = 0.5 * (ring_edge(i, rings) + ring_edge(i + 1, rings));
    const double turn = i * kGoldenRatio;  // neighboring rings do not line up
    for (int k = 0; k < spokes; ++k) {
      const double phi = azimuth + 2 * kPiD * (k + turn - std::floor(turn)) / spokes;
      const Vec3d h(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      const double cosine = glm::dot(Vec3d(wv), h);
      if (cosine <= 0) continue;
      const Vec3 wl(glm::normalize(2 * cosine * h - Vec3d(wv)));
      if (wl.z <= 0) continue;
      grid.wl.push_back(wl);
      grid.weight.push_back(static_cast<float>(4 * cosine * cell));
      grid.ring.push_back(static_cast<uint32_t>(i));
    }
  }
  return grid;
}

void redistribute_weights(LightGrid& grid, std::span<const uint8_t> kept) {
  const size_t rings = grid.ring.empty() ? 0 : grid.ring.back() + size_t{1};  // rings are in ascending order
  std::vector<double> all(rings, 0.0), left(rings, 0.0);
  for (size_t i = 0; i < grid.wl.size(); ++i) {
    all[grid.ring[i]] += grid.weight[i];
    if (kept[i]) left[grid.ring[i]] += grid.weight[i];
  }
  for (size_t i = 0; i < grid.wl.size(); ++i) {
    const uint32_t r = grid.ring[i];
    if (left[r] > 0) grid.weight[i] = static_cast<float>(grid.weight[i] * all[r] / left[r]);
  }
}

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
/// lobes reads some of the blocks only (brdf/fit/parametric/lobe_growth.cpp).
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

#include "fit/sample_bins.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "brdf/held_out.h"

namespace velour {
namespace {

constexpr double kBin = 1.0;  // degrees

/// The pair rotated about the normal so that wv lies on the meridian, with wl mirrored to y >= 0.
DirectionPair canonical(const Vec3& wl, const Vec3& wv) {
  const double azimuth = std::atan2(static_cast<double>(wv.y), static_cast<double>(wv.x));
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  const Vec3d l(c * wl.x + s * wl.y, std::abs(c * wl.y - s * wl.x), wl.z);
  return {Vec3(l), Vec3(static_cast<float>(std::hypot(wv.x, wv.y)), 0, wv.z)};
}

void add_sample(const ScatteredSample& sample, const Vec3& wl, const Vec3& wv, std::map<int, MeasuredSlice>& bins) {
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

std::vector<MeasuredSlice> bin_samples(std::span<const ScatteredSample> samples) {
  std::map<int, MeasuredSlice> bins;
  for (const ScatteredSample& s : samples) {
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

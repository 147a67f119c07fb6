#include "material/light_points.h"

#include <algorithm>

#include "srbf/kernel.h"
#include "srbf/plain_draws.h"

namespace velour {

namespace {

constexpr int kZeniths = 8, kAzimuths = 8;
static_assert(kZeniths * kAzimuths == DirectionBatch::kCapacity);

/// The lobes of `mixture` in their own frame; each lobe and the cosine get the same number of samples.
WarpedMixture evenly_sampled(const WarpedMixture& mixture) {
  WarpedMixture even = mixture;
  even.turn_cos = 1;
  even.turn_sin = 0;
  for (int j = 0; j < even.count; ++j) {
    const double bandwidth = std::max(static_cast<double>(even.bandwidth[j]), kMinMeanBandwidth);
    even.r[j] = even.g[j] = even.b[j] = static_cast<float>(1 / kernel_integral(Kernel::gaussian, bandwidth));
  }
  draw_plain_lobes(even, 1 / static_cast<float>(even.count + 1));
  even.list_all();
  for (int j = 0; j < even.count; ++j) even.r[j] = even.g[j] = even.b[j] = 1;
  return even;
}

}  // namespace

LightPoints::LightPoints(const WarpedMixture& mixture) {
  const WarpedMixture even = evenly_sampled(mixture);
  const auto components = static_cast<float>(even.count + 1);
  for (int component = 0; component <= even.count; ++component) {
    Vec2 u[DirectionBatch::kCapacity];
    for (int i = 0; i < kZeniths; ++i) {
      for (int k = 0; k < kAzimuths; ++k) {
        const float zenith = (static_cast<float>(i) + 0.5f) / kZeniths,
                    azimuth = (static_cast<float>(k) + 0.5f) / kAzimuths;
        u[i * kAzimuths + k] = {(static_cast<float>(component) + zenith) / components, azimuth};
      }
    }
    DirectionBatch samples, above;
    sample_warped(even, u, samples);
    for (int i = 0; i < samples.count; ++i) {
      if (samples.z[i] > 1e-6f) above.push(samples.get(i));
    }
    if (above.count > 0) add(even, above);
  }
  value_.resize(size());
  for (int j = 0; j < mixture.count; ++j) {
    const auto brightness = static_cast<double>(luminance({mixture.r[j], mixture.g[j], mixture.b[j]}));
    for (size_t i = 0; i < size(); ++i) value_[i] += brightness * kernel(i, j);
  }
  for (size_t i = 0; i < size(); ++i) {
    weight_[i] *= value_[i] * static_cast<double>(light_[i].z);
    per_value_.push_back(value_[i] > 0 ? 1 / value_[i] : 0);
    mass_ += weight_[i];
  }
}

void LightPoints::add(const WarpedMixture& even, const DirectionBatch& wl) {
  DirectionBatch padded = wl;
  while (padded.count <= 2) padded.push(wl.get(0));  // eval_warped() ignores the lobe list for one or two directions
  padded.pad();
  RgbBatch f;
  ScalarBatch density;
  eval_warped(even, padded, f, density);
  for (int i = 0; i < wl.count; ++i) {
    light_.push_back(wl.get(i));
    const double samples = static_cast<double>(even.count + 1) * kZeniths * kAzimuths;
    weight_.push_back(1 / (samples * static_cast<double>(density.v[i])));
  }
  WarpedMixture one = even;
  one.listed_count = 1;
  for (uint8_t j = 0; j < even.count; ++j) {
    one.listed = &j;
    eval_warped(one, padded, f);
    for (int i = 0; i < wl.count; ++i) kernel_[j].push_back(f.r[i]);
  }
}

}  // namespace velour

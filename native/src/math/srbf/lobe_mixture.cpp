#include "math/srbf/lobe_mixture.h"

#include <algorithm>
#include <cassert>

namespace velour {

void LobeMixture::add(const Vec3& center, float lobe_bandwidth, const Rgb& coefficient) {
  const float luminance_now = std::max(luminance(coefficient), 0.0f);
  const float mass = luminance_now * static_cast<float>(kernel_integral(kernel, lobe_bandwidth));
  append({&center.x, &center.y, &center.z, &lobe_bandwidth, &coefficient.r, &coefficient.g, &coefficient.b,
          &luminance_now, &mass, 1},
         Mat3(1), 1);
}

// Until finish(), `density` holds luminances and `cdf` masses.
void LobeMixture::append(const LobeSpan& lobes, const Mat3& rotation, float weight) {
  assert(count + lobes.count <= kCapacity);
  const int at = count;
  for (int j = 0; j < lobes.count; ++j) {
    const float cx = lobes.x[j], cy = lobes.y[j], cz = lobes.z[j];
    x[at + j] = rotation[0].x * cx + rotation[1].x * cy + rotation[2].x * cz;
    y[at + j] = rotation[0].y * cx + rotation[1].y * cy + rotation[2].y * cz;
    z[at + j] = rotation[0].z * cx + rotation[1].z * cy + rotation[2].z * cz;
  }
  std::copy_n(lobes.bandwidth, lobes.count, bandwidth + at);
  const auto scale = [&](const float* from, float* to) {
    for (int j = 0; j < lobes.count; ++j) to[at + j] = weight * from[j];
  };
  scale(lobes.r, r);
  scale(lobes.g, g);
  scale(lobes.b, b);
  scale(lobes.luminance, density);
  scale(lobes.mass, cdf);
  count += lobes.count;
}

void LobeMixture::finish(float defensive_share) {
  float total = 0;
  for (int j = 0; j < count; ++j) cdf[j] = total += cdf[j];
  const float diffuse = kPi * std::max(luminance({diffuse_r, diffuse_g, diffuse_b}), 0.0f);
  if (!(total >= kMinMass)) {
    cosine_share = 1;
    std::fill_n(density, count, 0.0f);
    return;
  }
  cosine_share = defensive_share + (1 - defensive_share) * (diffuse / (diffuse + total));
  const float scale = (1 - cosine_share) / total;
  for (int j = 0; j < count; ++j) density[j] *= scale;
  for (int j = 0; j < count; ++j) cdf[j] /= total;  // dividing makes the last one exactly 1
}

}  // namespace velour

#include "srbf/lobe_mixture.h"

#include <algorithm>
#include <cassert>

#include "sphere/discrete_choice.h"
#include "sphere/frame.h"
#include "sphere/warp.h"

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
  if (total <= 0) {
    cosine_share = 1;
    std::fill_n(density, count, 0.0f);
    return;
  }
  cosine_share = defensive_share + (1 - defensive_share) * (diffuse / (diffuse + total));
  const float scale = (1 - cosine_share) / total;
  for (int j = 0; j < count; ++j) density[j] *= scale;
  for (int j = 0; j < count; ++j) cdf[j] /= total;  // a quotient, not a product: the last one is then exactly 1
}

namespace {

Vec3 sample_lobe(const LobeMixture& mixture, int j, double u_zenith, float u_azimuth) {
  const auto d = static_cast<float>(kernel_sample(mixture.kernel, mixture.bandwidth[j], u_zenith));
  const float sine = std::sqrt(d * (2 - d));
  const float phi = 2 * kPi * u_azimuth;
  const Frame frame = Frame::about({mixture.x[j], mixture.y[j], mixture.z[j]});
  return frame.to_world({sine * std::cos(phi), sine * std::sin(phi), 1 - d});
}

}  // namespace

Vec3 sample_mixture(const LobeMixture& mixture, const Vec2& u) {
  double rest = middle_of_step(u.x);
  const double share = mixture.cosine_share;
  if (rest < share) {
    const float u_cosine = std::min(static_cast<float>(rest / share), 1 - 0x1p-24f);
    return sample_cosine_hemisphere({u_cosine, u.y});
  }
  rest = (rest - share) / (1 - share);
  const int lobe = choose_index(mixture.cdf, mixture.count, rest);
  return sample_lobe(mixture, lobe, rest, u.y);
}

}  // namespace velour

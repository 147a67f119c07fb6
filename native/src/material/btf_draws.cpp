#include "material/btf_draws.h"

#include <array>
#include <cmath>
#include <limits>

#include "sphere/random.h"
#include "sphere/warp.h"
#include "srbf/kernel.h"

namespace velour {
namespace {

// Best or second best by variance under uniform light for both a glossy weave and gravel, among bandwidths of 6 to 13
// and tilts of 45 to 60 degrees. Nineteen lobes gain another tenth at three times the evaluations.
constexpr float kBandwidth = 8.0f, kTilt = 0.85f;
constexpr int kBroad = BtfLook::kBroad, kHalf = kBroad, kLobes = kBroad + 1;
constexpr float kMinReliefCosine = 0.05f;  // between view and relief normal; no visible highlight below it

struct BroadLobes {
  std::array<Vec3, kBroad> center;
  std::array<float, kBroad> share;  // own value at its center over the sum of all lobes there, at equal strengths

  BroadLobes() {
    center[0] = Vec3(0, 0, 1);
    for (int i = 1; i < kBroad; ++i) {
      center[static_cast<size_t>(i)] = direction(kTilt, 2 * kPi * static_cast<float>(i - 1) / (kBroad - 1));
    }
    for (size_t i = 0; i < kBroad; ++i) {
      float all = 0;
      for (const Vec3& other : center) all += kernel(other, center[i]);
      share[i] = 1 / all;
    }
  }
  static float kernel(const Vec3& center, const Vec3& w) { return std::exp(kBandwidth * (glm::dot(center, w) - 1)); }
};
const BroadLobes kBroadLobes;

float integral(float bandwidth) { return static_cast<float>(kernel_integral(Kernel::gaussian, bandwidth)); }

void set_lobe(WarpedMixture& m, int j, const Vec3& center, float bandwidth, bool half) {
  m.half[j] = half ? 1.0f : 0.0f;
  m.s_xx[j] = m.s_yy[j] = 1;
  m.s_xy[j] = 0;
  m.x[j] = m.draw_x[j] = center.x;
  m.y[j] = m.draw_y[j] = center.y;
  m.z[j] = m.draw_z[j] = center.z;
  m.bandwidth[j] = m.draw_bandwidth[j] = bandwidth;
  m.draw_tail[j] = std::exp(-2 * bandwidth);
  m.r[j] = m.g[j] = m.b[j] = 0;
}

/// Estimated integral of each lobe.
std::array<float, kLobes> masses(const BtfLook& look, float half_bandwidth) {
  std::array<float, kLobes> mass;
  const Vec3 mirror = BtfDraws::mirror(look.wv, look.normal);
  float broad = 0;
  const float broad_integral = 2 * kPi / kBandwidth;
  for (size_t i = 0; i < kBroad; ++i) {
    const float strength = kBroadLobes.share[i] * look.broad[i];
    broad += strength * BroadLobes::kernel(kBroadLobes.center[i], mirror);
    mass[i] = strength * broad_integral;
  }
  mass[kHalf] = 0;
  const float cosine = glm::dot(look.wv, look.normal);
  if (half_bandwidth > 0 && cosine > kMinReliefCosine) {
    const float beyond = std::max(look.mirror - broad, 0.0f);
    mass[kHalf] =
        beyond * 4 * cosine * (2 * kPi / half_bandwidth);  // Jacobian of half-vector lobes: docs/engine/equations.md
  }
  return mass;
}

void fill_mixture(const BtfLook& look, const std::array<float, kLobes>& mass, float half_bandwidth, float cosine_share,
                  WarpedMixture& m) {
  float all = 0;
  for (const float x : mass) all += x;
  m.count = kLobes;
  m.padded = WarpedMixture::padded_of(kLobes);
  m.turn_cos = 1;
  m.turn_sin = 0;
  m.wv = look.wv;
  m.list_all();
  // Plain cosine sampling where all queried values are 0.
  const float cosine = all > 0 ? cosine_share : 1.0f;
  m.sums[WarpedMixture::kSums - 2] = 0;
  m.sums[WarpedMixture::kSums - 1] = cosine;
  const float bandwidth = std::max(half_bandwidth, 1.0f), half_integral = integral(bandwidth);
  static const float broad_integral = integral(kBandwidth);
  float sum = cosine;
  for (int j = 0; j < m.padded; ++j) {
    const bool broad = j < kBroad;
    const float probability = j < kLobes && all > 0 ? (1 - cosine) * mass[static_cast<size_t>(j)] / all : 0.0f;
    set_lobe(m, j, broad ? kBroadLobes.center[static_cast<size_t>(j)] : look.normal, broad ? kBandwidth : bandwidth,
             !broad);
    m.density[j] = probability / (broad ? broad_integral : half_integral);
    m.sums[WarpedMixture::kSums + j] = sum += probability;
  }
}

std::vector<Vec3> spread_by_cosine() {
  constexpr uint32_t kLights = 256;
  std::vector<Vec3> lights;
  for (uint32_t i = 0; i < kLights; ++i) {
    RandomStream random(0, i, 1);
    lights.push_back(sample_cosine_hemisphere(random.next2()));
  }
  return lights;
}

/// Sum over the examples of the log of (1 + relative variance) of one sample under uniform light.
double cost_of(const std::vector<BtfDraws::Example>& examples, float half_bandwidth, float cosine_share) {
  const std::vector<Vec3>& lights = BtfDraws::even_lights();
  double cost = 0;
  for (const BtfDraws::Example& example : examples) {
    WarpedMixture mixture;
    fill_mixture(example.look, masses(example.look, half_bandwidth), half_bandwidth, cosine_share, mixture);
    double first = 0, second = 0;
    for (size_t l = 0; l < lights.size(); ++l) {
      Rgb none;
      float pdf;
      eval_warped(mixture, lights[l], none, pdf);
      const double cosine = static_cast<double>(pdf_cosine_hemisphere(lights[l])),
                   f = static_cast<double>(example.f[l]);
      first += f / cosine;
      second += f * f / (cosine * static_cast<double>(pdf));
    }
    if (first > 0) cost += std::log(second * static_cast<double>(lights.size()) / (first * first));
  }
  return cost;
}

}  // namespace

const std::vector<Vec3>& BtfDraws::even_lights() {
  static const std::vector<Vec3> lights = spread_by_cosine();
  return lights;
}

const std::array<Vec3, BtfLook::kBroad>& BtfDraws::centers() { return kBroadLobes.center; }

BtfDraws::BtfDraws(const std::vector<Example>& examples) {
  double least = std::numeric_limits<double>::infinity();
  for (const float bandwidth : {0.0f, 15.0f, 30.0f, 60.0f, 120.0f, 240.0f, 480.0f}) {
    for (const float share : {1.0f, 0.7f, 0.4f, 0.2f, 0.1f}) {
      const double cost = cost_of(examples, bandwidth, share);
      if (!(cost < least)) continue;
      least = cost;
      half_bandwidth_ = bandwidth;
      cosine_share_ = share;
    }
  }
}

bool BtfDraws::asks_mirror(const Vec3& wv, const Vec3& normal) const {
  return asks() && half_bandwidth_ > 0 && glm::dot(wv, normal) > kMinReliefCosine;
}

void BtfDraws::fill(const BtfLook& look, WarpedMixture& mixture) const {
  std::array<float, kLobes> mass{};
  if (asks()) mass = masses(look, half_bandwidth_);
  fill_mixture(look, mass, half_bandwidth_, cosine_share_, mixture);
}

void BtfDraws::propose(const WarpedMixture& mixture, ProposalLobes& lobes) {
  static_assert(kLobes <= ProposalLobes::kCapacity);
  lobes.cosine = mixture.cosine() / kPi;
  lobes.count = 0;
  for (int j = 0; j < kBroad; ++j) {
    lobes.lobe[lobes.count++] = {
        {mixture.draw_x[j], mixture.draw_y[j], mixture.draw_z[j]}, kBandwidth, mixture.density[j]};
  }
  const Vec3 normal(mixture.draw_x[kHalf], mixture.draw_y[kHalf], mixture.draw_z[kHalf]);
  const float cosine = glm::dot(normal, mixture.wv);
  if (!(mixture.density[kHalf] > 0)) return;
  // Near the mirror direction the half vector turns by half the light's angle, and solid angles shrink by 4 cosine.
  lobes.lobe[lobes.count++] = {2 * cosine * normal - mixture.wv, mixture.draw_bandwidth[kHalf] / (4 * cosine),
                               mixture.density[kHalf] / (4 * cosine)};
}

}  // namespace velour

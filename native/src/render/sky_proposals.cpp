#include "render/sky_proposals.h"

#include <algorithm>
#include <cmath>

#include "job/parallel.h"
#include "sphere/octahedral.h"
#include "srbf/kernel.h"

namespace velour {
namespace {

/// A clipped cosine is about 1.17 exp(2.13 (t - 1)): the Gaussian of the same first two moments.
constexpr float kCosineBandwidth = 2.13f, kCosineAmplitude = 1.17f;
constexpr float kLeastProduct = 0.0025f;  // of a product's mass

/// Times as sharp as the BRDF's lobe is a sun of the lights: its disk then is a point to the lobe.
constexpr float kSunSharpness = 16;
constexpr double kSunEnergy = 0.6;  // of the sky's
constexpr double kBlurred = 0.2;    // misfit: 0.3 to 0.4 of small lamps in a studio, 0.1 of a square by day

int level_of(float bandwidth, int levels) {
  const int level = static_cast<int>(std::lround(0.5f * std::log2(std::max(bandwidth, 1.0f))));
  return std::min(level, levels - 1);
}

GaussianLobes lobes_of(const SkyMixture& sky) {
  GaussianLobes lobes;
  for (size_t k = 0; k < sky.size(); ++k) {
    lobes.add({sky.center[k], sky.bandwidth[k], luminance(sky.coefficient[k])});
  }
  return lobes;
}

}  // namespace

SkyProposals::SkyProposals(const SkyMixture& sky, double misfit) : blurs_edges_(misfit > kBlurred) {
  constexpr size_t kLists = static_cast<size_t>(kSide) * kSide * kLevels;
  for (auto* values : {&lists_.x, &lists_.y, &lists_.z, &lists_.bandwidth, &lists_.amplitude}) {
    values->assign(kLists * kListed, values == &lists_.z || values == &lists_.bandwidth ? 1.0f : 0.0f);
  }
  listed_.assign(kLists, 0);
  GaussianLobes lobes = lobes_of(sky);
  set_sun(lobes);
  const LobeTree tree(lobes);
  if (tree.empty()) return;
  parallel_fill(kLists, [&](size_t list) { fill_list(list, tree); });
}

/// Takes it out of `sky`, but never the last lobe: something must be left to propose.
void SkyProposals::set_sun(GaussianLobes& sky) {
  constexpr float kNarrow = 1000;  // a deviation below two degrees
  if (sky.size() < 2) return;
  double total = 0;
  const auto energy = [&sky](size_t k) {
    return static_cast<double>(sky.amplitude[k]) *
           kernel_integral(Kernel::gaussian, static_cast<double>(sky.bandwidth[k]));
  };
  for (size_t k = 0; k < sky.size(); ++k) total += energy(k);
  for (size_t k = 0; k < sky.size(); ++k) {
    if (sky.bandwidth[k] < kNarrow || energy(k) < kSunEnergy * total) continue;
    sun_.add({{sky.x[k], sky.y[k], sky.z[k]}, sky.bandwidth[k], sky.amplitude[k]});
    while (sun_.size() < LobeProducts::kLanes) sun_.add({{0, 0, 1}, 1, 0});
    sky.amplitude[k] = 0;
    return;
  }
}

void SkyProposals::fill_list(size_t list, const LobeTree& tree) {
  // A lobe anywhere in the cell and of any bandwidth of the level, blurred into one.
  constexpr float kCellVariance = 4 / (3.0f * kSide * kSide);
  const int cell = static_cast<int>(list / kLevels), level = static_cast<int>(list % kLevels);
  const float bandwidth = 1 / (std::exp2(-2.0f * static_cast<float>(level)) + kCellVariance);
  size_t to = list * kListed;
  for (const GaussianLobe& node : tree.cut({octahedral_cell_center(cell, kSide), bandwidth, 1}, kListed)) {
    lists_.x[to] = node.center.x;
    lists_.y[to] = node.center.y;
    lists_.z[to] = node.center.z;
    lists_.bandwidth[to] = node.bandwidth;
    lists_.amplitude[to] = node.amplitude;
    ++to;
  }
  constexpr size_t kLanes = LobeProducts::kLanes;
  listed_[list] = static_cast<uint8_t>((to - list * kListed + kLanes - 1) / kLanes * kLanes);
}

void SkyProposals::multiply(const GaussianLobe& world, const Frame& frame, LobeProducts& products) const {
  const int cell = octahedral_cell(world.center, kSide), level = level_of(world.bandwidth, kLevels);
  const auto list = static_cast<size_t>(cell * kLevels + level);
  multiply_lobes(world, lists_, list * kListed, listed_[list], &frame.z, products);
  if (has_sun() && sun_.bandwidth[0] < kSunSharpness * world.bandwidth) {
    multiply_lobes(world, sun_, 0, LobeProducts::kLanes, &frame.z, products);
  }
}

bool SkyProposals::propose(const ProposalLobes& brdf, const Frame& frame, LobeProducts& scratch,
                           LobeMixture& density) const {
  static_assert((ProposalLobes::kCapacity + 1) * (kListed + LobeProducts::kLanes) <= LobeProducts::kCapacity);
  scratch.count = 0;
  if (brdf.cosine > 0) multiply({frame.z, kCosineBandwidth, kCosineAmplitude * brdf.cosine}, frame, scratch);
  for (int j = 0; j < brdf.count; ++j) {
    const GaussianLobe& lobe = brdf.lobe[j];
    multiply({frame.to_world(lobe.center), lobe.bandwidth, lobe.amplitude}, frame, scratch);
  }
  return keep_products(scratch, kLeastProduct, density);
}

}  // namespace velour

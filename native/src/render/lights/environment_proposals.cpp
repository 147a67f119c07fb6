#include "render/lights/environment_proposals.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include "base/parallel.h"
#include "material/material.h"
#include "math/sphere/warp.h"
#include "math/srbf/kernel.h"

namespace velour {

namespace {

/// A clipped cosine is about 1.17 exp(2.13 (t - 1)): the Gaussian with the same first two moments.
constexpr float kCosineBandwidth = 2.13f, kCosineAmplitude = 1.17f;
constexpr float kMinProduct = 0.0025f;  // minimum share of the total mass

/// A sun this many times as sharp as the BRDF lobe is left to light sampling: to the lobe its disk is a point.
constexpr float kSunSharpness = 16;
constexpr double kSunEnergy = 0.6;  // minimum share of the environment's energy
constexpr double kBlurred = 0.2;    // misfit: 0.3 to 0.4 for small lights in a studio, 0.1 for a square by day

int level_of(float bandwidth, int levels) {
  const int level = static_cast<int>(std::lround(0.5f * std::log2(std::max(bandwidth, 1.0f))));
  return std::min(level, levels - 1);
}

GaussianLobes lobes_of(const EnvironmentMixture& sky) {
  GaussianLobes lobes;
  for (size_t k = 0; k < sky.size(); ++k) {
    lobes.add({sky.center[k], sky.bandwidth[k], luminance(sky.coefficient[k])});
  }
  return lobes;
}

}  // namespace

EnvironmentProposals::EnvironmentProposals(const EnvironmentMixture& sky, double misfit)
    : blurs_edges_(misfit > kBlurred) {
  constexpr size_t kLists = static_cast<size_t>(kSide) * kSide * kLevels;
  lists_.resize(kLists * kBlocks);
  blocks_.assign(kLists, 0);
  GaussianLobes lobes = lobes_of(sky);
  set_sun(lobes);
  const LobeTree tree(lobes);
  if (tree.empty()) return;
  parallel_fill(kLists, [&](size_t list) { fill_list(list, tree); });
}

/// Moves the sun out of `sky`, but never the last lobe: something must remain to propose.
void EnvironmentProposals::set_sun(GaussianLobes& sky) {
  constexpr float kNarrow = 1000;  // a standard deviation below two degrees
  if (sky.size() < 2) return;
  double total = 0;
  const auto energy = [&sky](size_t k) {
    return static_cast<double>(sky.amplitude[k]) *
           kernel_integral(Kernel::gaussian, static_cast<double>(sky.bandwidth[k]));
  };
  for (size_t k = 0; k < sky.size(); ++k) total += energy(k);
  for (size_t k = 0; k < sky.size(); ++k) {
    if (sky.bandwidth[k] < kNarrow || energy(k) < kSunEnergy * total) continue;
    sun_.emplace().set(0, {{sky.x[k], sky.y[k], sky.z[k]}, sky.bandwidth[k], sky.amplitude[k]});
    sky.amplitude[k] = 0;
    return;
  }
}

void EnvironmentProposals::fill_list(size_t list, const LobeTree& tree) {
  // A lobe anywhere in the cell and with any bandwidth of the level, blurred into one.
  constexpr float kCellVariance = 4 / (3.0f * kSide * kSide);
  const int cell = static_cast<int>(list / kLevels), level = static_cast<int>(list % kLevels);
  const float bandwidth = 1 / (std::exp2(-2.0f * static_cast<float>(level)) + kCellVariance);
  size_t count = 0;
  for (const GaussianLobe& node : tree.cut({octahedral_cell_center(cell, kSide), bandwidth, 1}, kListed)) {
    lists_[list * kBlocks + count / LobeBlock::kSize].set(count % LobeBlock::kSize, node);
    ++count;
  }
  blocks_[list] = static_cast<uint8_t>((count + LobeBlock::kSize - 1) / LobeBlock::kSize);
}

size_t EnvironmentProposals::list_of(const GaussianLobe& world) const {
  const int cell = octahedral_cell(world.center, kSide), level = level_of(world.bandwidth, kLevels);
  return static_cast<size_t>(cell * kLevels + level);
}

void EnvironmentProposals::multiply(const GaussianLobe& world, size_t list, const Vec3& normal,
                                    LobeProducts& products) const {
  multiply_lobes(world, {&lists_[list * kBlocks], blocks_[list]}, &normal, products);
  if (sun_ && sun_->bandwidth[0] < kSunSharpness * world.bandwidth) {
    multiply_lobes(world, {&*sun_, 1}, &normal, products);
  }
}

bool EnvironmentProposals::propose(const ProposalLobes& brdf, const Frame& frame, LobeProducts& scratch,
                                   LobeMixture& density) const {
  static_assert((ProposalLobes::kCapacity + 1) * (kListed + LobeProducts::kLanes) <= LobeProducts::kCapacity);
  GaussianLobe lobe[ProposalLobes::kCapacity + 1];
  size_t list[ProposalLobes::kCapacity + 1];
  int count = 0;
  const auto add = [&](const GaussianLobe& world) {
    lobe[count] = world;
    list[count] = list_of(world);
    // All lists together exceed the caches of a core; they are fetched while the first ones are multiplied.
    for (size_t line = 0; line < sizeof(LobeBlock) * blocks_[list[count]]; line += 64) {
      __builtin_prefetch(reinterpret_cast<const char*>(&lists_[list[count] * kBlocks]) + line);
    }
    ++count;
  };
  if (brdf.cosine > 0) add({frame.z, kCosineBandwidth, kCosineAmplitude * brdf.cosine});
  for (int j = 0; j < brdf.count; ++j) {
    const GaussianLobe& local = brdf.lobe[j];
    add({frame.to_world(local.center), local.bandwidth, local.amplitude});
  }
  scratch.count = 0;
  for (int j = 0; j < count; ++j) multiply(lobe[j], list[j], frame.z, scratch);
  return keep_products(scratch, kMinProduct, density);
}

namespace {

constexpr float kHalf = 0.5f;
constexpr float kBroad = 16;      // bandwidth: a standard deviation of 14 degrees, wider than a light
constexpr double kDiffuse = 0.9;  // minimum broad share of a diffuse material

}  // namespace

double broad_share(const Material& material) {
  ScratchArena arena;
  double broad = 0, all = 0;
  for (const float degrees : {10.0f, 30.0f, 50.0f, 70.0f}) {
    ProposalLobes lobes;
    arena.reset();
    if (!material.prepare(direction(radians_from(degrees), 0), arena)->proposal_lobes(lobes)) continue;
    const auto cosine = static_cast<double>(lobes.cosine * kPi);
    broad += cosine;
    all += cosine;
    for (int j = 0; j < lobes.count; ++j) {
      const GaussianLobe& lobe = lobes.lobe[j];
      const double mass =
          static_cast<double>(lobe.amplitude) * kernel_integral(Kernel::gaussian, static_cast<double>(lobe.bandwidth));
      all += mass;
      if (lobe.bandwidth < kBroad) broad += mass;
    }
  }
  return all > 0 ? broad / all : 0;
}

std::vector<float> lights_parts(const Scene& scene, const EnvironmentProposals& sky) {
  std::vector<float> parts;
  for (const SurfaceMaterial& m : scene.materials()) {
    const bool half = sky.has_sun() || (sky.blurs_edges() && broad_share(*m.material) > kDiffuse);
    parts.push_back(half ? kHalf : 0.0f);
  }
  return parts;
}

}  // namespace velour

#include "render/sky_proposals.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sphere/octahedral.h"

namespace velour {
namespace {

/// A clipped cosine is about 1.17 exp(2.13 (t - 1)): the Gaussian of the same first two moments.
constexpr float kCosineBandwidth = 2.13f, kCosineAmplitude = 1.17f;
constexpr float kLeastBrdfShare = 0.01f;  // of a BRDF lobe's probability; the other strategies have the rest
constexpr float kLeastProduct = 0.004f;   // of a product's mass
constexpr float kListedMass = 0.98f;      // of a list

int level_of(float bandwidth, int levels) {
  const int level = static_cast<int>(std::lround(0.5f * std::log2(std::max(bandwidth, 1.0f))));
  return std::min(level, levels - 1);
}

}  // namespace

namespace {

GaussianLobes lobes_of(const SkyMixture& sky, size_t most) {
  GaussianLobes lobes;
  for (size_t k = 0; k < std::min(sky.size(), most); ++k) {
    lobes.add({sky.center[k], sky.bandwidth[k], luminance(sky.coefficient[k])});
  }
  while (lobes.size() % LobeProducts::kLanes != 0) lobes.add({{0, 0, 1}, 1, 0});
  return lobes;
}

}  // namespace

SkyProposals::SkyProposals(const SkyMixture& fine, const SkyMixture& coarse) {
  const GaussianLobes fine_lobes = lobes_of(fine, kMostFine), coarse_lobes = lobes_of(coarse, kListed);
  constexpr size_t kLists = static_cast<size_t>(kSide) * kSide * kLevels;
  for (auto* values : {&lists_.x, &lists_.y, &lists_.z, &lists_.bandwidth, &lists_.amplitude}) {
    values->assign(kLists * kListed, values == &lists_.z || values == &lists_.bandwidth ? 1.0f : 0.0f);
  }
  listed_.assign(kLists, 0);
  tbb::parallel_for(size_t{0}, kLists, [&](size_t list) {
    LobeProducts scratch;
    fill_list(list, static_cast<int>(list % kLevels) < kFirstFine ? coarse_lobes : fine_lobes, scratch);
  });
}

void SkyProposals::fill_list(size_t list, const GaussianLobes& sky, LobeProducts& scratch) {
  // A lobe anywhere in the cell and of any bandwidth of the level, blurred into one.
  constexpr float kCellVariance = 4 / (3.0f * kSide * kSide);
  const int cell = static_cast<int>(list / kLevels), level = static_cast<int>(list % kLevels);
  const float bandwidth = 1 / (std::exp2(-2.0f * static_cast<float>(level)) + kCellVariance);
  const int count = static_cast<int>(sky.size());
  multiply_lobes({octahedral_cell_center(cell, kSide), bandwidth, 1}, sky, 0, count, nullptr, scratch);
  int order[LobeProducts::kCapacity];
  std::iota(order, order + count, 0);
  const auto heavier = [&](int a, int b) {
    return scratch.mass[a] != scratch.mass[b] ? scratch.mass[a] > scratch.mass[b] : a < b;
  };
  const int most = std::min(kListed, count);
  std::partial_sort(order, order + most, order + count, heavier);
  const float total = std::accumulate(scratch.mass, scratch.mass + count, 0.0f);
  float covered = 0;
  int listed = 0;
  while (listed < most && covered < kListedMass * total) {
    const auto from = static_cast<size_t>(order[listed]), to = list * kListed + static_cast<size_t>(listed);
    covered += scratch.mass[from];
    lists_.x[to] = sky.x[from];
    lists_.y[to] = sky.y[from];
    lists_.z[to] = sky.z[from];
    lists_.bandwidth[to] = sky.bandwidth[from];
    lists_.amplitude[to] = sky.amplitude[from];
    ++listed;
  }
  listed_[list] =
      static_cast<uint8_t>((listed + LobeProducts::kLanes - 1) / LobeProducts::kLanes * LobeProducts::kLanes);
}

void SkyProposals::multiply(const GaussianLobe& world, const Frame& frame, LobeProducts& products) const {
  const int cell = octahedral_cell(world.center, kSide), level = level_of(world.bandwidth, kLevels);
  const auto list = static_cast<size_t>(cell * kLevels + level);
  const int count = listed_[list];
  if (products.count + count > LobeProducts::kCapacity) return;
  multiply_lobes(world, lists_, list * kListed, count, &frame.z, products);
}

bool SkyProposals::propose(const LobeMixture& brdf, const Frame& frame, LobeProducts& scratch,
                           LobeMixture& density) const {
  scratch.count = 0;
  multiply({frame.z, kCosineBandwidth, kCosineAmplitude / kPi * brdf.cosine_share}, frame, scratch);
  float below = 0;
  for (int j = 0; j < brdf.count; ++j) {
    const float share = (brdf.cdf[j] - below) * (1 - brdf.cosine_share);
    below = brdf.cdf[j];
    if (share < kLeastBrdfShare) continue;
    multiply({frame.to_world({brdf.x[j], brdf.y[j], brdf.z[j]}), brdf.bandwidth[j], brdf.density[j]}, frame, scratch);
  }
  return keep_products(scratch, kLeastProduct, density);
}

}  // namespace velour

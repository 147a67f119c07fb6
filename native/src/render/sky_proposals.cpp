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

void SkyProposals::add(const SkyMixture& sky, size_t most) {
  for (size_t k = 0; k < std::min(sky.size(), most); ++k) {
    sky_.add({sky.center[k], sky.bandwidth[k], luminance(sky.coefficient[k])});
  }
}

SkyProposals::SkyProposals(const SkyMixture& fine, const SkyMixture& coarse) {
  add(coarse, kListed);
  coarse_ = static_cast<int>(sky_.size());
  add(fine, kMostFine);
  sky_.add({{0, 0, 1}, 1, 0});
  constexpr size_t kCells = static_cast<size_t>(kSide) * kSide;
  lists_.assign(kCells * kLevels * kListed, static_cast<int32_t>(sky_.size()) - 1);
  listed_.assign(kCells * kLevels, 0);
  tbb::parallel_for(size_t{0}, kCells, [&](size_t cell) {
    LobeProducts scratch;
    for (int level = 0; level < kLevels; ++level) fill_list(static_cast<int>(cell), level, scratch);
  });
}

void SkyProposals::fill_list(int cell, int level, LobeProducts& scratch) {
  // A lobe anywhere in the cell and of any bandwidth of the level, blurred into one.
  constexpr float kCellVariance = 4 / (3.0f * kSide * kSide);
  const float bandwidth = 1 / (std::exp2(-2.0f * static_cast<float>(level)) + kCellVariance);
  int32_t all[LobeProducts::kCapacity];
  const int empty = static_cast<int>(sky_.size()) - 1;
  const int first = level < kFirstFine ? 0 : coarse_, count = (level < kFirstFine ? coarse_ : empty) - first;
  const int padded = (count + LobeProducts::kLanes - 1) / LobeProducts::kLanes;
  for (int i = 0; i < padded * LobeProducts::kLanes; ++i) all[i] = i < count ? first + i : empty;
  scratch.count = 0;
  multiply_lobes({octahedral_cell_center(cell, kSide), bandwidth, 1}, sky_, all, padded * LobeProducts::kLanes, nullptr,
                 scratch);
  const auto heavier = [&](int32_t a, int32_t b) {
    return scratch.mass[a] != scratch.mass[b] ? scratch.mass[a] > scratch.mass[b] : a < b;
  };
  std::iota(all, all + count, 0);  // places in the scratch from here on
  const int most = std::min(kListed, count);
  std::partial_sort(all, all + most, all + count, heavier);
  const float total = std::accumulate(scratch.mass, scratch.mass + count, 0.0f);
  const size_t at = static_cast<size_t>(cell * kLevels + level);
  float covered = 0;
  int listed = 0;
  while (listed < most && covered < kListedMass * total) {
    covered += scratch.mass[all[listed]];
    lists_[at * kListed + static_cast<size_t>(listed)] = first + all[listed];
    ++listed;
  }
  listed_[at] = static_cast<uint8_t>((listed + LobeProducts::kLanes - 1) / LobeProducts::kLanes * LobeProducts::kLanes);
}

void SkyProposals::multiply(const GaussianLobe& world, const Frame& frame, LobeProducts& products) const {
  const int cell = octahedral_cell(world.center, kSide), level = level_of(world.bandwidth, kLevels);
  const int count = listed_[static_cast<size_t>(cell * kLevels + level)];
  if (products.count + count > LobeProducts::kCapacity) return;
  multiply_lobes(world, sky_, list(cell, level), count, &frame.z, products);
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

#include "compress/shared_lobes.h"

#include <algorithm>
#include <numeric>

#include "compress/lobe_refinement.h"

namespace velour {
namespace {

constexpr size_t kColorPoints = 128, kColorPairs = 500;  // used by the weaker color axes to choose

}  // namespace

SharedLobes chosen_lobes(const LobeOrder& order, size_t coefficients, uint64_t seed) {
  const LobeCandidates candidates = random_candidates(seed);
  const size_t count = order.share(coefficients)[0];
  std::vector<size_t> chosen(order.candidate[0].begin(), order.candidate[0].begin() + static_cast<ptrdiff_t>(count));
  std::sort(chosen.begin(), chosen.end());  // lobes in the tile's frame first
  SharedLobes shared;
  for (const size_t i : chosen) {
    shared.lobes.push_back(candidates.lobes[i]);
    shared.tile_lobes += i < candidates.tile_lobes;
  }
  shared.lobe[0].resize(count);
  std::iota(shared.lobe[0].begin(), shared.lobe[0].end(), uint16_t{0});
  return shared;
}

void refine_lobes(const std::vector<SurfacePoint>& points, const std::array<size_t, 3>& share,
                  const LobeRefinement& options, SharedLobes& lobes, Progress& progress) {
  const RefinementOptions refinement{lobes.tile_lobes, options.steps, options.threads};
  lobes.lobes = refine_lobes(points, std::move(lobes.lobes), refinement, progress);
  const auto columns =
      candidate_columns(points, {lobes.lobes, lobes.tile_lobes}, kColorPoints, kColorPairs, options.threads, progress);
  for (size_t a = 1; a < 3; ++a) {
    const PursuitChoice choice =
        pursue(columns, point_values(points, columns, a), std::min(share[a], share[0]), options.threads, progress);
    for (const size_t i : choice.order) lobes.lobe[a].push_back(static_cast<uint16_t>(i));
  }
}

}  // namespace velour

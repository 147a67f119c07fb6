#include "compress/scene_levels.h"

#include <algorithm>
#include <cmath>

#include "compress/resampled_map.h"

namespace velour {
namespace {

TexelLevel at_size(const TexelLevel& level, size_t values, const Eigen::MatrixXf& x, const Eigen::MatrixXf& y) {
  return {static_cast<uint32_t>(x.rows()), static_cast<uint32_t>(y.rows()), resampled(level.value, values, x, y)};
}

SrbfLevel at_size(const SrbfLevel& level, size_t values, const Eigen::MatrixXf& x, const Eigen::MatrixXf& y) {
  return {static_cast<uint32_t>(x.rows()), static_cast<uint32_t>(y.rows()), resampled(level.relief, 1, x, y),
          resampled(level.value, values, x, y)};
}

/// The coarsest level of at least this size; of the finest one asked for, the finest.
template <class Level>
const Level& source_of(const std::vector<Level>& levels, uint32_t width, uint32_t height, bool finest) {
  size_t l = 0;
  const auto holds = [&](const Level& level) { return level.width >= width && level.height >= height; };
  const bool same = levels[0].width == width && levels[0].height == height;
  while (!(finest && !same) && l + 1 < levels.size() && holds(levels[l + 1])) ++l;
  return levels[l];
}

template <class Level>
std::vector<Level> pyramid_at(const std::vector<Level>& levels, const TexelGrid& grid, size_t values, double window) {
  std::vector<Level> out;
  for (uint32_t width = grid.width, height = grid.height;; width = half_of(width), height = half_of(height)) {
    const Level& from = source_of(levels, width, height, out.empty());
    const bool same = from.width == width && from.height == height;
    out.push_back(
        same ? from
             : at_size(from, values, resampling(from.width, width, window), resampling(from.height, height, window)));
    if (width == 1 && height == 1) return out;
  }
}

FactoredBtf at_resolution(FactoredBtf btf, const TexelGrid& grid, double window) {
  btf.levels = pyramid_at(btf.levels, grid, btf.components(), window);
  btf.grid = grid;
  return btf;
}

SrbfBtf at_resolution(SrbfBtf btf, const TexelGrid& grid, double window) {
  for (SrbfSide& side : btf.sides) side.levels = pyramid_at(side.levels, grid, side.coefficients(), window);
  btf.grid = grid;
  return btf;
}

}  // namespace

TexelGrid seen_grid(const TexelGrid& full, const SurfaceDomain& seen) {
  const double most = std::max(full.width, full.height);
  const double share = std::min(1.0, kTexelsOfLookUp / (finest_footprint(seen) * most));
  const auto scaled = [share](uint32_t texels) {
    return static_cast<uint32_t>(std::max(1L, std::lround(share * texels)));
  };
  return {scaled(full.width), scaled(full.height), full.tile_metres};
}

ModelBody at_resolution(const ModelBody& body, const TexelGrid& grid, double window) {
  if (const auto* factored = std::get_if<FactoredBtf>(&body)) return at_resolution(*factored, grid, window);
  return at_resolution(std::get<SrbfBtf>(body), grid, window);
}

}  // namespace velour

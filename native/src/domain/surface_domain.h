// How finely, and where on its tile, scenes show a material that varies over the surface.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "domain/view_weights.h"

namespace velour {

/// Weights as in SceneDomain; all zero of a uniform material, of which nothing of this is looked up.
struct SurfaceDomain {
  static constexpr int kBins = 128, kBinsOfOctave = 8;
  static constexpr int kTileCells = 16;

  /// By the width of one look-up (FootprintTaps): bin i holds those of 2^(i/8 - 16) to 2^((i + 1)/8 - 16) of the tile's
  /// side that has more texels; the first and the last bin also hold what is beyond.
  std::array<double, kBins> footprint{};
  /// By place on the tile: kTileCells x kTileCells cells, row by row from the bottom.
  std::array<double, kTileCells * kTileCells> tile{};
  /// By direction; all zero where nobody knows (SceneDomain::directions).
  ViewWeights views;

  double weight() const;
};

/// The number of texels along that side at which bin 0 begins with one texel.
inline constexpr float kFinestTexels = 65536;

/// `level`: log2 of the width of a look-up where the tile has kFinestTexels texels.
void add_seen(SurfaceDomain& domain, float level, const Vec2& uv, double weight);
void merge(SurfaceDomain& into, const SurfaceDomain& other);

/// The width of the finest bin that counts, as a share of the tile's side: its upper end. Finer bins, of at most
/// kOutside of the weight together, do not. Infinite where nothing was seen.
double finest_footprint(const SurfaceDomain& domain);

/// Texels of the finest level along a look-up that it is fine enough for. A look-up stands for a whole pixel, while a
/// render sends several rays through it, which see within it: with one texel a look-up their interpolation would blur
/// what the rays' mean keeps.
inline constexpr double kTexelsOfLookUp = 2;

/// Whether `texels` along the tile's side are enough for look-ups of this width.
inline bool resolves(uint32_t texels, double footprint) { return footprint * texels >= kTexelsOfLookUp; }

/// The share of the weight for which `texels` along the tile's side are too few, 0..1; bins count by their upper ends.
/// 1 where nothing was seen.
double share_finer_than(const SurfaceDomain& domain, uint32_t texels);

/// The share of the tile's cells that were seen at all.
double seen_share_of_tile(const SurfaceDomain& domain);

}  // namespace velour

// Scene usage of a material: the views and lights under which scenes show it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>
#include "math/sphere/vec.h"
#include "math/sphere/view_spline.h"

namespace velour {

// Distribution of the directions from which a tile is seen.

/// Weights (SceneDomain) of views by direction in the tile's frame: +x along the first texture coordinate, +y
/// perpendicular to it on the side where the second increases, z < 0 behind.
struct ViewWeights {
  static constexpr int kRings = 18, kSectors = 72;  // 5 degrees each: theta, phi
  static constexpr size_t kSide = size_t{kRings} * kSectors;

  /// [side][ring][sector], front first.
  std::array<double, 2 * kSide> weight{};

  double sum() const;
};

/// `w`: unit, toward the viewer.
void add_view(ViewWeights& views, const Vec3& w, double weight);
void merge(ViewWeights& into, const ViewWeights& other);

/// Spreads weights by polar angle, one degree each, evenly over all azimuths and both sides.
ViewWeights all_around(const std::array<double, 90>& by_degree);
/// Weights for a tile that looks the same from both sides: each bin also gets the weight of its counterpart behind.
ViewWeights from_both_sides(const ViewWeights& views);

/// Centers of the bins that count: all but the lightest ones, which hold at most kOutside of the weight together.
std::vector<Vec3> counted_views(const ViewWeights& views);
/// Largest angle between a direction in a bin and the center of the bin, radians.
inline constexpr double kBinRadius = 3.55 * (kPiD / 180);

/// Share of `frame` that is seen from elsewhere: farther than one and a half bins from the centers of the bins that
/// count in `known`. 0..1; 0 if nothing was seen.
double share_from_elsewhere(const ViewWeights& known, const ViewWeights& frame);

// Scene usage of a material that varies over the surface: how finely, and where on its tile, scenes show it.

/// Weights as in SceneDomain; all zero for a uniform material, which has no texture look-ups.
struct SurfaceDomain {
  static constexpr int kBins = 128, kBinsOfOctave = 8;
  static constexpr int kTileCells = 16;

  /// Weights by the width of a look-up (FootprintTaps): bin i holds widths of 2^(i/8 - 16) to 2^((i + 1)/8 - 16) of the
  /// tile side with more texels; the first and last bins also hold everything beyond.
  std::array<double, kBins> footprint{};
  /// Weights by position on the tile: kTileCells x kTileCells cells, row by row from the bottom.
  std::array<double, kTileCells * kTileCells> tile{};
  /// Weights by direction; all zero if unknown (SceneDomain::directions).
  ViewWeights views;

  double weight() const;
};

/// Number of texels along that side for which bin 0 begins at the width of one texel.
inline constexpr float kFinestTexels = 65536;

/// `level`: log2 of the width of a look-up, in texels of a tile with kFinestTexels texels.
void add_seen(SurfaceDomain& domain, float level, const Vec2& uv, double weight);
void merge(SurfaceDomain& into, const SurfaceDomain& other);

/// Upper end of the finest bin that counts, as a share of the tile side. Finer bins, with at most kOutside of the
/// weight together, are ignored. Infinite if nothing was seen.
double finest_footprint(const SurfaceDomain& domain);

/// Minimum number of texels of the finest level across the width of a look-up. A look-up covers a whole pixel, but a
/// render sends several rays through it that resolve detail within it: with one texel per look-up, interpolation would
/// blur what the mean of the rays preserves.
inline constexpr double kTexelsOfLookUp = 2;

/// Whether `texels` along the tile's side suffice for look-ups of this width.
inline bool resolves(uint32_t texels, double footprint) { return footprint * texels >= kTexelsOfLookUp; }

/// Share of the weight for which `texels` along the tile's side are too few, 0..1; bins count by their upper ends. 1 if
/// nothing was seen.
double share_finer_than(const SurfaceDomain& domain, uint32_t texels);

/// Share of the tile's cells that were seen at all.
double seen_share_of_tile(const SurfaceDomain& domain);

/// The weight of a hit is its contribution to the image: the luminance of the path's throughput at the hit, in camera
/// rays.
struct SceneDomain {
  static constexpr int kViewBins = 90;  // theta_v, one degree each

  /// Weight of the hits, by the view's polar angle.
  std::array<double, kViewBins> view{};
  /// Camera rays that the weights were accumulated over, hits or not, in all frames.
  uint64_t camera_rays = 0;
  uint64_t frames = 0;
  /// Density of the most concentrated light seen, 1/sr: the density with which the renderer samples its direction from
  /// lights, which is one over the solid angle of a single light; infinite for a delta light.
  double light_density = 0;
  /// SHA-256 of everything observed in a frame; for several frames the word-wise sum, which does not depend on their
  /// order.
  std::array<uint64_t, 4> hash{};
  /// Only for materials that vary over the surface.
  SurfaceDomain surface;

  double weight() const;
  /// surface.views, or all_around(view) where these are unknown, as in files of earlier versions.
  ViewWeights directions() const;
};

/// The shortest range of whole bins that leaves out at most `kOutside` of the weight at either end, widened by a degree
/// at both ends.
ViewRange view_range(const SceneDomain& domain);
constexpr double kOutside = 1e-4;

/// Light more than this many times as concentrated as a domain's most concentrated light is outside the domain.
constexpr double kSharperLight = 2;

}  // namespace velour

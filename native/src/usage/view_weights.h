// Distribution of the directions from which a tile is seen.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "math/sphere/vec.h"

namespace velour {

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

}  // namespace velour

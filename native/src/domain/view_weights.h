// From which directions a tile is seen.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "sphere/vec.h"

namespace velour {

/// Weights (SceneDomain) of views by direction in the tile's frame: +x along the first texture coordinate, +y to the
/// side that the second grows to, z < 0 from behind.
struct ViewWeights {
  static constexpr int kRings = 18, kSectors = 72;  // of 5 degrees each: theta, phi
  static constexpr size_t kSide = size_t{kRings} * kSectors;

  /// [side][ring][sector], the front first.
  std::array<double, 2 * kSide> weight{};

  double sum() const;
};

/// `w`: unit, towards the viewer.
void add_view(ViewWeights& views, const Vec3& w, double weight);
void merge(ViewWeights& into, const ViewWeights& other);

/// What weights by polar angle alone, a degree each, leave open: all azimuths, both sides.
ViewWeights all_around(const std::array<double, 90>& by_degree);
/// Of a tile that is the same from both sides.
ViewWeights from_both_sides(const ViewWeights& views);

/// Middles of the bins that count: all but the lightest, of kOutside of the weight together.
std::vector<Vec3> counted_views(const ViewWeights& views);
/// No direction of a bin is farther from its middle, radians.
inline constexpr double kBinRadius = 3.55 * (kPiD / 180);

/// The share of `frame` that is seen from elsewhere: farther than one and a half bins from the middles of those that
/// count in `known`. 0..1; 0 where nothing was seen.
double share_from_elsewhere(const ViewWeights& known, const ViewWeights& frame);

}  // namespace velour

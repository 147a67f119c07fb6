#include "usage/scene_domain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace velour {

double SceneDomain::weight() const { return std::accumulate(view.begin(), view.end(), 0.0); }

ViewWeights SceneDomain::directions() const { return surface.views.sum() > 0 ? surface.views : all_around(view); }

ViewRange view_range(const SceneDomain& domain) {
  const double outside = kOutside * domain.weight();
  int begin = 0, end = SceneDomain::kViewBins;
  for (double left = 0; begin < end && (left += domain.view[static_cast<size_t>(begin)]) <= outside;) ++begin;
  for (double left = 0; end > begin && (left += domain.view[static_cast<size_t>(end - 1)]) <= outside;) --end;
  if (begin == end) return {};
  return {std::max(0, begin - 1), std::min(SceneDomain::kViewBins, end + 1)};
}

namespace {

/// Upper end of bin `i`, as a share of the tile side.
double end_of_bin(size_t i) {
  const double octave = static_cast<double>(i + 1) / SurfaceDomain::kBinsOfOctave;
  return std::exp2(octave) / static_cast<double>(kFinestTexels);
}

size_t cell_of(float coordinate) {
  const float inside = std::isfinite(coordinate) ? coordinate - std::floor(coordinate) : 0.0f;
  const int cell = static_cast<int>(inside * SurfaceDomain::kTileCells);
  return static_cast<size_t>(std::min(cell, SurfaceDomain::kTileCells - 1));  // rounding may give kTileCells
}

}  // namespace

double SurfaceDomain::weight() const { return std::accumulate(footprint.begin(), footprint.end(), 0.0); }

void add_seen(SurfaceDomain& domain, float level, const Vec2& uv, double weight) {
  // A NaN becomes 0: the finest level, which leaves nothing out.
  const float place = level > 0 ? level * SurfaceDomain::kBinsOfOctave : 0.0f;
  domain.footprint[static_cast<size_t>(std::min(place, SurfaceDomain::kBins - 1.0f))] += weight;
  domain.tile[cell_of(uv.y) * SurfaceDomain::kTileCells + cell_of(uv.x)] += weight;
}

void merge(SurfaceDomain& into, const SurfaceDomain& other) {
  for (size_t i = 0; i < into.footprint.size(); ++i) into.footprint[i] += other.footprint[i];
  for (size_t i = 0; i < into.tile.size(); ++i) into.tile[i] += other.tile[i];
  merge(into.views, other.views);
}

double finest_footprint(const SurfaceDomain& domain) {
  const double all = domain.weight();
  if (!(all > 0)) return std::numeric_limits<double>::infinity();
  size_t bin = 0;
  for (double left = 0; bin + 1 < domain.footprint.size(); ++bin) {
    left += domain.footprint[bin];
    if (left > kOutside * all) break;
  }
  return end_of_bin(bin);
}

double share_finer_than(const SurfaceDomain& domain, uint32_t texels) {
  const double all = domain.weight();
  if (!(all > 0)) return 1.0;
  double finer = 0;
  for (size_t i = 0; i < domain.footprint.size() && !resolves(texels, end_of_bin(i)); ++i) finer += domain.footprint[i];
  return std::min(1.0, finer / all);
}

double seen_share_of_tile(const SurfaceDomain& domain) {
  const auto seen = std::ranges::count_if(domain.tile, [](double weight) { return weight > 0; });
  return static_cast<double>(seen) / static_cast<double>(domain.tile.size());
}

}  // namespace velour

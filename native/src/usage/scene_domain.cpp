#include "usage/scene_domain.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace velour {

namespace {

constexpr double kBin = 0.5 * kPiD / ViewWeights::kRings;
constexpr double kReach = 1.5 * kBin;

size_t bin_of(const Vec3& w) {
  const double theta = std::acos(std::min(1.0, std::abs(static_cast<double>(w.z))));
  const double phi = std::atan2(static_cast<double>(w.y), static_cast<double>(w.x));
  const auto ring = std::min(static_cast<size_t>(theta / kBin), size_t{ViewWeights::kRings - 1});
  const auto sector = static_cast<size_t>((phi < 0 ? phi + 2 * kPiD : phi) / kBin) % ViewWeights::kSectors;
  return (w.z < 0 ? ViewWeights::kSide : 0) + ring * ViewWeights::kSectors + sector;
}

Vec3 middle_of(size_t bin) {
  const size_t place = bin % ViewWeights::kSide;
  const auto ring = static_cast<double>(place / ViewWeights::kSectors);
  const auto sector = static_cast<double>(place % ViewWeights::kSectors);
  Vec3 w = direction(static_cast<float>((ring + 0.5) * kBin), static_cast<float>((sector + 0.5) * kBin));
  if (bin >= ViewWeights::kSide) w.z = -w.z;
  return w;
}

std::vector<size_t> counted_bins(const ViewWeights& views) {
  std::vector<size_t> bins;
  for (size_t i = 0; i < views.weight.size(); ++i) {
    if (views.weight[i] > 0) bins.push_back(i);
  }
  std::ranges::stable_sort(bins, [&](size_t a, size_t b) { return views.weight[a] < views.weight[b]; });
  const double outside = kOutside * views.sum();
  size_t light = 0;
  for (double left = 0; light + 1 < bins.size() && (left += views.weight[bins[light]]) <= outside;) ++light;
  bins.erase(bins.begin(), bins.begin() + static_cast<std::ptrdiff_t>(light));
  std::ranges::sort(bins);
  return bins;
}

}  // namespace

double ViewWeights::sum() const { return std::accumulate(weight.begin(), weight.end(), 0.0); }

void add_view(ViewWeights& views, const Vec3& w, double weight) { views.weight[bin_of(w)] += weight; }

void merge(ViewWeights& into, const ViewWeights& other) {
  for (size_t i = 0; i < into.weight.size(); ++i) into.weight[i] += other.weight[i];
}

ViewWeights all_around(const std::array<double, 90>& by_degree) {
  constexpr size_t kDegrees = 90 / ViewWeights::kRings;
  ViewWeights views;
  for (size_t i = 0; i < views.weight.size(); ++i) {
    const size_t ring = i % ViewWeights::kSide / ViewWeights::kSectors;
    for (size_t d = 0; d < kDegrees; ++d) {
      views.weight[i] += by_degree[ring * kDegrees + d] / (2 * ViewWeights::kSectors);
    }
  }
  return views;
}

ViewWeights from_both_sides(const ViewWeights& views) {
  ViewWeights both = views;
  for (size_t i = 0; i < both.weight.size(); ++i) {
    both.weight[i] += views.weight[(i + ViewWeights::kSide) % both.weight.size()];
  }
  return both;
}

std::vector<Vec3> counted_views(const ViewWeights& views) {
  std::vector<Vec3> middles;
  for (const size_t bin : counted_bins(views)) middles.push_back(middle_of(bin));
  return middles;
}

double share_from_elsewhere(const ViewWeights& known, const ViewWeights& frame) {
  const std::vector<Vec3> middles = counted_views(known);
  const auto least = static_cast<float>(std::cos(kReach));
  double elsewhere = 0;
  for (size_t i = 0; i < frame.weight.size(); ++i) {
    if (!(frame.weight[i] > 0)) continue;
    const Vec3 w = middle_of(i);
    const bool near = std::ranges::any_of(middles, [&](const Vec3& m) { return m.z * w.z > 0 && dot(m, w) >= least; });
    if (!near) elsewhere += frame.weight[i];
  }
  const double all = frame.sum();
  return all > 0 ? elsewhere / all : 0.0;
}

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

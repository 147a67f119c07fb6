#include "usage/view_weights.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "usage/scene_domain.h"

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

}  // namespace velour

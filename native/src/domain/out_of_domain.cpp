#include "domain/out_of_domain.h"

#include <algorithm>

namespace velour {
namespace {

constexpr double kBin = 1.5707963267948966 / SceneDomain::kViewBins;

/// Part of bin `i` that lies within `range`.
double overlap(size_t i, const ViewRange& range) {
  const double begin = static_cast<double>(i), low = range.begin / kBin, high = range.end / kBin;
  return std::clamp(std::min(begin + 1.0, high) - std::max(begin, low), 0.0, 1.0);
}

double share_of_views_outside(const ViewRange& range, const SceneDomain& frame) {
  double outside = 0;
  for (size_t i = 0; i < frame.view.size(); ++i) outside += (1.0 - overlap(i, range)) * frame.view[i];
  return outside / frame.weight();
}

bool within(const ViewRange& range, double theta) { return theta >= range.begin && theta <= range.end; }

}  // namespace

double out_of_domain(const SceneDomain& domain, const ViewRange& range, const SceneObservation& frame) {
  if (frame.hits.empty() || !(frame.domain.weight() > 0.0)) return 0.0;
  const double most = kSharperLight * domain.light_density;
  const auto sharper = std::ranges::count_if(frame.hits, [&](const ObservedHit& hit) {
    return within(range, theta_of(hit.wv)) && static_cast<double>(hit.light_density) > most;
  });
  const double by_light = static_cast<double>(sharper) / static_cast<double>(frame.hits.size());
  return std::min(1.0, share_of_views_outside(range, frame.domain) + by_light);
}

}  // namespace velour

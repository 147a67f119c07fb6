#include "domain/out_of_domain.h"

#include <algorithm>

namespace velour {
namespace {

/// Whether bin `i` lies within `range`; both are in whole degrees.
bool holds(const ViewRange& range, size_t i) {
  const int degree = static_cast<int>(i);
  return degree >= range.begin && degree < range.end;
}

double share_of_views_outside(const ViewRange& range, const SceneDomain& frame) {
  double outside = 0;
  for (size_t i = 0; i < frame.view.size(); ++i) outside += holds(range, i) ? 0.0 : frame.view[i];
  return outside / frame.weight();
}

}  // namespace

double out_of_domain(const SceneDomain& domain, const ViewRange& range, const SceneObservation& frame) {
  if (frame.hits.empty() || !(frame.domain.weight() > 0.0)) return 0.0;
  const double most = kSharperLight * domain.light_density;
  const auto sharper = std::ranges::count_if(frame.hits, [&](const ObservedHit& hit) {
    return range.holds(theta_of(hit.wv)) && static_cast<double>(hit.light_density) > most;
  });
  const double by_light = static_cast<double>(sharper) / static_cast<double>(frame.hits.size());
  return std::min(1.0, share_of_views_outside(range, frame.domain) + by_light);
}

double out_of_views(const SceneDomain& domain, const SceneObservation& frame) {
  return share_from_elsewhere(domain.directions(), frame.domain.directions());
}

double out_of_resolution(uint32_t texels, const SceneObservation& frame) {
  return frame.domain.weight() > 0.0 ? share_finer_than(frame.domain.surface, texels) : 0.0;
}

}  // namespace velour

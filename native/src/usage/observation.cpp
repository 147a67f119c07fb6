#include "usage/observation.h"

#include <algorithm>

namespace velour {

namespace {

/// Appends `hit` with those of its terms whose direction satisfies `wanted`.
template <typename Wanted>
void append(SceneObservation& into, const SceneObservation& from, const ObservedHit& hit, const Wanted& wanted) {
  ObservedHit same = hit;
  same.first = same.middle = static_cast<uint32_t>(into.wl.size());
  for (uint32_t i = hit.first; i < hit.last; ++i) {
    if (!wanted(from.wl[i])) continue;
    into.wl.push_back(from.wl[i]);
    into.light.push_back(from.light[i]);
    if (i < hit.middle) ++same.middle;
  }
  same.last = static_cast<uint32_t>(into.wl.size());
  into.hits.push_back(same);
}

void append(SceneObservation& into, const SceneObservation& from, const ObservedHit& hit) {
  append(into, from, hit, [](const Vec3&) { return true; });
}

void merge(SceneDomain& into, const SceneDomain& other) {
  for (size_t i = 0; i < into.view.size(); ++i) into.view[i] += other.view[i];
  for (size_t i = 0; i < into.hash.size(); ++i) into.hash[i] += other.hash[i];
  merge(into.surface, other.surface);
  into.camera_rays += other.camera_rays;
  into.frames += other.frames;
  into.light_density = std::max(into.light_density, other.light_density);
}

}  // namespace

SceneObservation reflected_part(const SceneObservation& observation) {
  SceneObservation part;
  part.domain = observation.domain;
  for (const ObservedHit& hit : observation.hits) {
    append(part, observation, hit, [](const Vec3& wl) { return wl.z > 0; });
  }
  return part;
}

void merge(SceneObservation& into, const SceneObservation& other) {
  const SceneObservation before = std::move(into);
  into = {};
  into.domain = before.domain;
  merge(into.domain, other.domain);
  for (size_t a = 0, b = 0; into.hits.size() < SceneObservation::kHits;) {
    const bool has_a = a < before.hits.size(), has_b = b < other.hits.size();
    if (!has_a && !has_b) break;
    if (has_a && (!has_b || before.hits[a].key <= other.hits[b].key)) {
      append(into, before, before.hits[a++]);
    } else {
      append(into, other, other.hits[b++]);
    }
  }
}

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

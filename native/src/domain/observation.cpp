#include "domain/observation.h"

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

}  // namespace velour

#include "domain/observation.h"

#include <algorithm>

namespace velour {
namespace {

void append(SceneObservation& into, const SceneObservation& from, const ObservedHit& hit) {
  const auto first = static_cast<uint32_t>(into.wl.size());
  const auto range = [&hit](const auto& all) { return std::pair(all.begin() + hit.first, all.begin() + hit.last); };
  const auto [wl, wl_end] = range(from.wl);
  const auto [light, light_end] = range(from.light);
  into.wl.insert(into.wl.end(), wl, wl_end);
  into.light.insert(into.light.end(), light, light_end);
  into.hits.push_back({hit.key, hit.wv, first, first + (hit.middle - hit.first), static_cast<uint32_t>(into.wl.size()),
                       hit.light_density, hit.back});
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

#include "render/indirect_light.h"

namespace velour {

void IndirectLight::clear() {
  flight_.paths.clear();
  flight_.rays.clear();
  flight_.hits.clear();
  flight_.samples.clear();
}

void IndirectLight::add(const Ray& ray, const RayCone& cone, const Hit& hit, const PathNumbers& numbers) {
  flight_.paths.push_back({numbers, Rgb(1.0f), static_cast<uint32_t>(flight_.samples.size()), cone});
  flight_.rays.push_back(ray);
  flight_.hits.push_back(hit);
  flight_.samples.emplace_back();
}

void IndirectLight::resolve(int surfaces) {
  for (int met = 1; met <= surfaces && !flight_.paths.empty(); ++met) {
    meet_surfaces();
    flight_.gather(met < surfaces, nullptr);
    flight_.trace(hidden::kFromBounces);
  }
}

void IndirectLight::meet_surfaces() {
  flight_.receivers.clear();
  for (size_t i = 0; i < flight_.paths.size(); ++i) {
    if (flight_.hits[i].instance == kNoHit) continue;
    Path& path = flight_.paths[i];
    const Vertex vertex = Vertex::seen(scene_, flight_.rays[i], flight_.hits[i], path.cone, nullptr);
    if (!flight_.light.counts_glow(flight_.hits[i]))
      flight_.samples[path.sample].radiance += path.throughput * vertex.emission();
    flight_.receivers.push_back(
        {vertex, &path.numbers, path.throughput, path.sample, kIndirectDirections, kIndirectDirections});
  }
}

}  // namespace velour

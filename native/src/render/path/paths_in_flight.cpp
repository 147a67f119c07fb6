#include "render/path/paths_in_flight.h"

#include <algorithm>

namespace velour {

void PathsInFlight::trace_continued() {
  kinds_.clear();
  for (const Path& path : paths) {
    kinds_.push_back(path.past.was_transmitted ? hidden::kFromTransmission : hidden::kFromBounces);
  }
  trace({.each = kinds_});
}

void PathsInFlight::trace(const RayKinds& kinds) {
  hits.resize(rays.size());
  passed_.resize(visible.dims() ? rays.size() : 0);
  decisions_.clear();
  for (size_t i = 0; i < passed_.size(); ++i) decisions_.push_back(paths[i].numbers.decisions());
  visible.intersect(rays, hits.data(), kinds, visible.dims() ? passed_.data() : nullptr, decisions_);
  for (size_t i = 0; i < passed_.size(); ++i) paths[i].throughput *= passed_[i];
  add_awaited();
}

void PathsInFlight::add_awaited() {
  for (const AwaitedLight& a : awaited_) {
    const Hit& hit = hits[a.place];
    if (hit.instance != kNoHit && hit.distance <= a.far) continue;
    samples[paths[a.place].sample].radiance += clamped(a.light, a.limit);
  }
  awaited_.clear();
}

size_t PathsInFlight::gather(bool go_on, RayLog* log) {
  next_.clear();
  next_rays_.clear();
  const std::span<const Receiver> all(receivers);
  const size_t most = all.empty() ? 1 : DirectLight::receivers_of(all[0].full);
  for (size_t first = 0; first < all.size(); first += most) {
    const auto batch = all.subspan(first, std::min(most, all.size() - first));
    light.gather(batch, go_on, shadows_, samples);
    if (go_on) extend(batch);
  }
  const size_t shadow_rays = shadows_.resolve(visible, samples, log);
  paths.swap(next_);
  rays.swap(next_rays_);
  return shadow_rays;
}

void PathsInFlight::extend(std::span<const Receiver> batch) {
  size_t path_of[DirectLight::kReceivers] = {};
  for (size_t k = 0; k < batch.size(); ++k) {
    const Receiver& receiver = batch[k];
    const auto continuation = light.extend(receiver, k);
    if (!continuation) continue;
    const PathPast past = light.past_after(receiver, k, *continuation);
    receiver.numbers->next_vertex();
    path_of[k] = next_.size();
    next_.push_back({*receiver.numbers, continuation->throughput, receiver.sample, receiver.vertex.cone, past,
                     light.counts_all_emissive(k)});
    next_rays_.push_back(continuation->ray);
  }
  for (const AwaitedLight& a : light.awaited()) awaited_.push_back({path_of[a.place], a.light, a.limit, a.far});
}

void IndirectLight::clear() {
  flight_.paths.clear();
  flight_.rays.clear();
  flight_.hits.clear();
  flight_.samples.clear();
}

void IndirectLight::add(const Ray& ray, const RayCone& cone, const Hit& hit, const PathNumbers& numbers) {
  flight_.paths.push_back({numbers,
                           Rgb(1.0f),
                           static_cast<uint32_t>(flight_.samples.size()),
                           cone,
                           {},
                           flight_.light.counts_all_emissive()});
  flight_.rays.push_back(ray);
  flight_.hits.push_back(hit);
  flight_.samples.emplace_back();
}

void IndirectLight::resolve(int surfaces) {
  for (int met = 1; met <= surfaces && !flight_.paths.empty(); ++met) {
    meet_surfaces();
    flight_.gather(met < surfaces, nullptr);
    flight_.trace_continued();
  }
}

void IndirectLight::meet_surfaces() {
  flight_.receivers.clear();
  for (size_t i = 0; i < flight_.paths.size(); ++i) {
    if (flight_.hits[i].instance == kNoHit) continue;
    Path& path = flight_.paths[i];
    const Vertex vertex = Vertex::seen(scene_, flight_.rays[i], flight_.hits[i], path.cone, nullptr);
    if (!flight_.light.counts_emissive(flight_.hits[i], path.counted_all_emissive)) {
      const Rgb emitted = path.throughput * vertex.emission();
      if (flight_.light.keeps(emitted)) flight_.samples[path.sample].radiance += emitted;
    }
    flight_.receivers.push_back(
        {vertex, &path.numbers, path.throughput, path.sample, kIndirectDirections, kIndirectDirections});
  }
}

}  // namespace velour

#include "render/indirect_light.h"

namespace velour {
namespace {

/// Light directions of a vertex, as beyond the first one of a camera ray.
constexpr int kDirections = 2;

}  // namespace

void IndirectLight::clear() {
  paths_.clear();
  rays_.clear();
  hits_.clear();
  samples_.clear();
}

void IndirectLight::add(const Ray& ray, const RayCone& cone, const Hit& hit, const PathNumbers& numbers) {
  paths_.push_back({numbers, Rgb(1.0f), static_cast<uint32_t>(samples_.size()), cone});
  rays_.push_back(ray);
  hits_.push_back(hit);
  samples_.emplace_back();
}

void IndirectLight::resolve(int surfaces) {
  for (int met = 1; met <= surfaces && !paths_.empty(); ++met) {
    meet_surfaces();
    gather(met < surfaces);
    shadows_.resolve(visible_, samples_, nullptr);
    paths_.swap(next_);
    rays_.swap(next_rays_);
    trace();
  }
}

void IndirectLight::meet_surfaces() {
  receivers_.clear();
  for (size_t i = 0; i < paths_.size(); ++i) {
    if (hits_[i].instance == kNoHit) continue;
    Path& path = paths_[i];
    const Vertex vertex = Vertex::seen(scene_, rays_[i], hits_[i], path.cone, nullptr);
    if (!light_.counts_glow(hits_[i])) samples_[path.sample].radiance += path.throughput * vertex.emission();
    receivers_.emplace_back(vertex, &path.numbers, path.throughput, path.sample, kDirections, kDirections);
  }
}

void IndirectLight::gather(bool go_on) {
  next_.clear();
  next_rays_.clear();
  const std::span<const Receiver> all(receivers_);
  const size_t most = DirectLight::receivers_of(kDirections);
  for (size_t first = 0; first < all.size(); first += most) {
    const auto batch = all.subspan(first, std::min(most, all.size() - first));
    light_.gather(batch, shadows_, samples_);
    for (size_t k = 0; k < batch.size() && go_on; ++k) {
      const auto onward = light_.extend(batch[k], k);
      if (!onward) continue;
      batch[k].numbers->next_vertex();
      next_.push_back({*batch[k].numbers, onward->throughput, batch[k].sample, batch[k].vertex.cone});
      next_rays_.push_back(onward->ray);
    }
  }
}

void IndirectLight::trace() {
  hits_.resize(rays_.size());
  passed_.resize(visible_.tints() ? rays_.size() : 0);
  visible_.intersect(rays_, hits_.data(), hidden::kFromBounces, visible_.tints() ? passed_.data() : nullptr);
  for (size_t i = 0; i < passed_.size(); ++i) paths_[i].throughput *= passed_[i];
}

}  // namespace velour

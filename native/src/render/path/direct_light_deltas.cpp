// Light and continuations along lobes without width.
#include <cmath>
#include <limits>

#include "render/path/direct_light.h"

namespace velour {

namespace {

bool is_finite(const Rgb& c) { return std::isfinite(c.r + c.g + c.b); }

}  // namespace

void DirectLight::gather_deltas(std::span<const Receiver> receivers, Output output) {
  static_assert(kReceivers * DeltaLobes::kCapacity <= DirectionBatch::kCapacity);
  terms_.clear();
  for (size_t k = 0; k < receivers.size(); ++k) {
    work_[k].shared_term = -1;
    add_deltas(receivers[k], static_cast<uint8_t>(k));
  }
  if (terms_.world.count == 0 || !lighting_.has_extended()) return;
  along_deltas_ = true;
  settle(receivers, output);
  if (!lighting_.emissive().empty()) settle_emissive(receivers, output);
  along_deltas_ = false;
}

/// Each lobe is the only technique for its direction, with a density of 1 in place of its own.
void DirectLight::add_deltas(const Receiver& receiver, uint8_t place) {
  const Vertex& vertex = receiver.vertex;
  Work& work = work_[place];
  for (int i = 0; i < work.deltas.count; ++i) {
    const DeltaLobes::Lobe& lobe = work.deltas.lobe[i];
    const Vec3 wl_world = vertex.frame.to_world(lobe.wl);
    if (!vertex.receives(lobe.wl, wl_world)) continue;
    const int to = terms_.world.count;
    const Rgb reflected = receiver.throughput * in_working_space(working_space_, vertex, lobe.weight);
    terms_.world.push(wl_world);
    terms_.reflected.set(to, reflected);
    terms_.product.v[to] = terms_.light_share.v[to] = 0.0f;
    terms_.surface.v[to] = 1.0f;
    terms_.technique[to] = Technique::surface;
    terms_.receiver[to] = place;
    terms_.aim[to] = 0;
    if (work.along_delta != i) continue;
    work.continuation = Continuation{vertex.ray(wl_world, std::numeric_limits<float>::infinity()),
                                     reflected / work.along_share, lobe.wl, std::numeric_limits<float>::infinity()};
    const bool shares_ray = shares_rays_ && is_finite(work.continuation->throughput) && vertex.rays_agree(wl_world);
    if (shares_ray) work.shared_term = to;
  }
}

void DirectLight::choose_continuation(const Receiver& receiver, bool go_on, Work& work) {
  work.along_delta = -1;
  work.along_share = 1.0f;
  if (work.deltas.count == 0 || !go_on) return;
  float all = work.deltas.rest;
  for (int i = 0; i < work.deltas.count; ++i) all += luminance(work.deltas.lobe[i].weight);
  if (!(all > 0.0f)) return;
  float left = receiver.numbers->lobe() * all;
  for (int i = 0; i < work.deltas.count; ++i) {
    const float own = luminance(work.deltas.lobe[i].weight);
    left -= own;
    if (left >= 0.0f || !(own > 0.0f)) continue;
    work.along_delta = i;
    work.along_share = own / all;
    return;
  }
  work.along_share = work.deltas.rest / all;
}

}  // namespace velour

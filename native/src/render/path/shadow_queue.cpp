#include "render/path/shadow_queue.h"

#include <algorithm>
#include "render/options.h"
#include "render/path/shell_crossing.h"
#include "render/path/vertex.h"
#include "render/ray_log.h"

namespace velour {

size_t ShadowQueue::resolve(const VisibleRays& visible, std::vector<CameraSample>& samples, RayLog* log) {
  const size_t count = rays_.size();
  blocked_.resize(count);
  if (log != nullptr) log->add(rays_, RayLog::Kind::occlusion);
  passed_.resize(visible.dims() ? count : 0);
  visible.occluded(rays_, blocked_.data(), visible.dims() ? passed_.data() : nullptr);
  for (size_t i = 0; i < count; ++i) {
    if (!visible.tells_apart(kinds_[i])) continue;
    Hit hit;
    visible.intersect({&rays_[i], 1}, &hit, {kinds_[i]}, visible.dims() ? &passed_[i] : nullptr);
    blocked_[i] = hit.instance != kNoHit;
  }
  for (size_t i = 0; i < passed_.size(); ++i) light_[i] *= passed_[i];
  for (size_t i = 0; i < count; ++i) {
    if (blocked_[i] == 0) samples[sample_[i]].radiance += clamped(light_[i], limit_[i]);
  }
  rays_.clear();
  kinds_.clear();
  light_.clear();
  sample_.clear();
  limit_.clear();
  return count;
}

namespace {

constexpr size_t kTogether = 128;

/// Element `i` of an array that may be null.
Rgb* behind(Rgb* passed, size_t i) { return passed != nullptr ? passed + i : nullptr; }

/// Part of an array that may be empty.
std::span<const RayDecisions> part(std::span<const RayDecisions> all, size_t first, size_t count) {
  return all.empty() ? all : all.subspan(first, count);
}

/// Ways through shells that are traced together, as long as they belong to the same field.
class ShellWays {
 public:
  ShellWays(Hit* hits, bool* met) : hits_(hits), met_(met) {}

  void add(const ShellCrossing& crossing, size_t number) {
    if (field_ != &crossing.field()) trace();
    field_ = &crossing.field();
    way_[count_] = crossing.way();
    number_[count_++] = static_cast<uint8_t>(number);
  }
  /// Determines which of the ways hit the structure, and where.
  void trace() {
    if (count_ > 0) trace_shells(*field_, {way_, count_}, found_);
    for (size_t i = 0; i < count_; ++i) {
      met_[number_[i]] = found_[i].met;
      if (!found_[i].met) continue;
      hits_[number_[i]].shell_begin = found_[i].begin;
      hits_[number_[i]].shell_s = found_[i].s;
    }
    count_ = 0;
  }

 private:
  Hit* hits_;
  bool* met_;
  const ShellField* field_ = nullptr;
  size_t count_ = 0;
  ShellWay way_[kTogether];
  ShellHit found_[kTogether];
  uint8_t number_[kTogether];
};

}  // namespace

/// Rays in flight, with the nearest surface that each has reached.
struct VisibleRays::Pending {
  size_t count = 0;
  Ray ray[kTogether];
  Hit hit[kTogether];
  Hit passed[kTogether];  // the previous hit
  uint8_t kind[kTogether];
  uint8_t number[kTogether];
  uint32_t decided[kTogether];  // number of surfaces decided about

  void add(const Ray& r, const Hit& h, uint8_t k, size_t n) {
    ray[count] = r;
    hit[count] = h;
    kind[count] = k;
    passed[count] = Hit{};
    decided[count] = 0;
    number[count++] = static_cast<uint8_t>(n);
  }
  void move(size_t from, size_t to) {
    ray[to] = ray[from];
    hit[to] = hit[from];
    passed[to] = passed[from];
    kind[to] = kind[from];
    number[to] = number[from];
    decided[to] = decided[from];
  }
  /// Makes a ray continue behind its hit.
  void pass(size_t i) {
    passed[i] = hit[i];
    go_beyond(ray[i], hit[i]);
  }
  bool again(size_t i) const { return same_crossing(hit[i], passed[i]); }
};

VisibleRays::VisibleRays(const Scene& scene)
    : scene_(scene),
      shells_(std::ranges::any_of(scene.materials(), [](const SurfaceMaterial& m) { return m.shell != nullptr; })),
      all_opaque_(!shells_ && std::ranges::all_of(
                                  scene.materials(),
                                  [](const SurfaceMaterial& m) { return m.material->opaque() && !m.hides_backs(); })),
      dims_(std::ranges::any_of(scene.materials(), [](const SurfaceMaterial& m) { return !m.material->opaque(); })) {
  for (const Scene::Instance& i : scene.instances()) {
    const bool from_shadows = (i.hidden & hidden::kFromShadows) != 0;
    for (const uint8_t kind : {hidden::kFromBounces, hidden::kFromTransmission}) {
      if (((i.hidden & kind) != 0) != from_shadows) apart_ |= kind;
    }
  }
}

void VisibleRays::intersect(std::span<const Ray> rays, Hit* hits, const RayKinds& kinds, Rgb* passed,
                            std::span<const RayDecisions> decisions) const {
  scene_.rays().intersect(rays, hits, kinds);
  if (passed != nullptr) std::fill_n(passed, rays.size(), Rgb(1.0f));
  if (all_opaque_) return;
  for (size_t done = 0; done < rays.size(); done += kTogether) {
    const size_t count = std::min(kTogether, rays.size() - done);
    pass_on(rays.subspan(done, count), hits + done, kinds.part(done, count), behind(passed, done),
            part(decisions, done, count));
  }
}

bool VisibleRays::occluded(const Ray& ray, Rgb* passed) const {
  uint8_t blocked;
  occluded({&ray, 1}, &blocked, passed);
  return blocked != 0;
}

void VisibleRays::occluded(std::span<const Ray> rays, uint8_t* blocked, Rgb* passed) const {
  if (passed != nullptr) std::fill_n(passed, rays.size(), Rgb(1.0f));
  if (all_opaque_) return scene_.rays().occluded(rays, blocked, {hidden::kFromShadows});
  for (size_t done = 0; done < rays.size(); done += kTogether) {
    occluded_some(rays.subspan(done, std::min(kTogether, rays.size() - done)), blocked + done, behind(passed, done));
  }
}

void VisibleRays::occluded_some(std::span<const Ray> rays, uint8_t* blocked, Rgb* passed) const {
  Ray asked[kTogether];
  Hit hit[kTogether];
  Rgb through[kTogether];
  uint8_t number[kTogether];
  // Rays that leave a shell hit its top in any case, so the occlusion query would be wasted.
  if (shells_) {
    std::fill_n(blocked, rays.size(), uint8_t{1});
  } else {
    scene_.rays().occluded(rays, blocked, {hidden::kFromShadows});
  }
  size_t count = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (blocked[i] == 0) continue;
    asked[count] = rays[i];
    number[count++] = static_cast<uint8_t>(i);
  }
  intersect({asked, count}, hit, {hidden::kFromShadows}, passed != nullptr ? through : nullptr);
  for (size_t i = 0; i < count; ++i) {
    blocked[number[i]] = hit[i].instance != kNoHit;
    if (passed != nullptr) passed[number[i]] = through[i];
  }
}

bool VisibleRays::meets_surface(Pending& pending, size_t i, Rgb* passed,
                                std::span<const RayDecisions> decisions) const {
  const Ray& ray = pending.ray[i];
  const Hit& hit = pending.hit[i];
  const uint8_t kind = pending.kind[i];
  const SurfaceMaterial& surface = scene_.materials()[scene_.material(hit)];
  const Material& material = *surface.material;
  if (passes_back(surface, ray, hit, kind)) return false;
  if (material.opaque()) return true;
  const SurfaceSite site = point_site(scene_, ray, hit, surface, kind);
  const float alpha = material.alpha(site);
  Rgb& left = passed[pending.number[i]];
  if (kind == hidden::kFromShadows) {
    left *= 1.0f - alpha;
    if (left == Rgb(0.0f)) return true;
  } else {
    const uint32_t before = pending.decided[i]++;
    const float number =
        decisions.empty() ? ray_number(ray, hit, RayDecision::alpha) : decisions[pending.number[i]].number(before);
    if (number < alpha) return true;
  }
  if (material.tints()) left *= material.passing(site);
  return false;
}

void VisibleRays::decide(Pending& pending, bool* met, Rgb* passed, std::span<const RayDecisions> decisions) const {
  ShellWays ways(pending.hit, met);
  for (size_t i = 0; i < pending.count; ++i) {
    const Hit& hit = pending.hit[i];
    met[i] = !pending.again(i) && meets_surface(pending, i, passed, decisions);
    if (!met[i] || !shells_ || !scene_.has_shell(hit)) continue;
    const ShellCrossing crossing(scene_, pending.ray[i], hit);
    met[i] = false;
    if (!crossing.way().empty()) ways.add(crossing, i);
  }
  ways.trace();
}

void VisibleRays::pass_on(std::span<const Ray> rays, Hit* hits, const RayKinds& kinds, Rgb* passed,
                          std::span<const RayDecisions> decisions) const {
  Pending pending;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].instance != kNoHit) pending.add(rays[i], hits[i], kinds[i], i);
  }
  bool met[kTogether];
  while (pending.count > 0) {
    decide(pending, met, passed, decisions);
    size_t left = 0;
    for (size_t i = 0; i < pending.count; ++i) {
      hits[pending.number[i]] = pending.hit[i];
      if (met[i]) continue;
      pending.pass(i);
      pending.move(i, left++);
    }
    scene_.rays().intersect({pending.ray, left}, pending.hit, {.each = {pending.kind, left}});
    pending.count = 0;
    for (size_t i = 0; i < left; ++i) {
      if (pending.hit[i].instance == kNoHit) {
        hits[pending.number[i]].instance = kNoHit;
      } else {
        pending.move(i, pending.count++);
      }
    }
  }
}

}  // namespace velour

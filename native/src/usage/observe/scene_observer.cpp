#include "usage/observe/scene_observer.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <string>
#include "base/parallel.h"
#include "material/material.h"
#include "material/normal_map.h"
#include "math/sphere/directions.h"
#include "render/path/vertex.h"
#include "render/preparation.h"
#include "usage/observation.h"
#include "usage/observe/hits.h"

namespace velour {

namespace {

/// Approximate number of camera rays of a frame.
constexpr double kPlaces = 65536;
/// Camera rays per task: a few milliseconds.
constexpr uint64_t kRaysOfBlock = 256;

/// kPlaces cells that are about square.
CameraGrid grid_of(const ObserverOptions& options) {
  const bool wide = options.width > options.height;
  const double ratio = static_cast<double>(options.width) / options.height;
  const double shorter = std::max(1.0, std::round(std::sqrt(kPlaces * (wide ? 1.0 / ratio : ratio))));
  const auto one = static_cast<uint64_t>(shorter), other = static_cast<uint64_t>(kPlaces / shorter);
  return wide ? CameraGrid{other, one} : CameraGrid{one, other};
}

/// Options of the render whose paths are followed; different `stream`s are independent.
RenderOptions render_options(const ObserverOptions& options, uint64_t stream) {
  RenderOptions render;
  render.width = options.width;
  render.height = options.height;
  render.bounces = options.bounces;
  render.seed = mix64(mix64(options.seed) + stream);
  return render;
}

/// One observation, from its start to its hash.
class Observer {
 public:
  Observer(const Scene& scene, uint32_t material, const ObserverOptions& options, Progress& progress)
      : scene_(scene),
        material_(scene.materials()[material]),
        grid_(grid_of(options)),
        paths_(render_options(options, 0)),
        halves_{render_options(options, 1), render_options(options, 2)},
        progress_(progress),
        lighting_(scene, progress),
        arena_(arena_concurrency(options.threads)) {}

  SceneObservation run() {
    progress_.stage("tracing camera rays", 0.0, 0.3);
    see_views();
    progress_.stage("gathering light", 0.3, 1.0);
    see_light();
    observation_.domain.hash = content_hash(observation_);
    progress_.update(1.0);
    return std::move(observation_);
  }

 private:
  template <typename Work>
  void in_parallel(size_t count, const Work& work) {
    std::atomic<size_t> finished{0};
    arena_.execute([&] {
      tbb::parallel_for(size_t{0}, count, [&](size_t i) {
        progress_.check();
        work(i);
        progress_.update(static_cast<double>(++finished) / static_cast<double>(count));
      });
    });
  }

  void see_views() {
    std::vector<SeenWeights> seen((grid_.cells() + kRaysOfBlock - 1) / kRaysOfBlock);
    in_parallel(seen.size(), [&](size_t i) {
      const uint64_t first = i * kRaysOfBlock;
      tracers_.local().follow(first, std::min(grid_.cells(), first + kRaysOfBlock), seen[i]);
    });
    SceneDomain& domain = observation_.domain;
    for (const SeenWeights& block : seen) {  // in a fixed order, independent of threads
      for (size_t i = 0; i < block.view.size(); ++i) domain.view[i] += block.view[i];
      merge(domain.surface, block.surface);
    }
    domain.camera_rays = grid_.cells();
    domain.frames = 1;
  }

  void see_light() {
    DrawByWeight<SeenHit> draws(SceneObservation::kHits);
    for (const ViewTracer& tracer : tracers_) draws.add(tracer.draws());
    const auto kept = draws.sorted();
    std::vector<HitLight> light(kept.size());
    in_parallel(kept.size(), [&](size_t i) {
      const SeenHit& hit = kept[i].item;
      light[i] = recorders_.local().record(hit.vertex, hit.bounces, kept[i].key);
    });
    for (size_t i = 0; i < kept.size(); ++i) append(kept[i].key, kept[i].item.vertex, light[i]);
  }

  void append(uint64_t key, const Vertex& vertex, const HitLight& found) {
    auto& [domain, hits, wl, light] = observation_;
    const auto first = static_cast<uint32_t>(wl.size());
    wl.insert(wl.end(), found.wl.begin(), found.wl.end());
    light.insert(light.end(), found.light.begin(), found.light.end());
    hits.push_back({key, above_horizon(vertex.wv), first, first + found.middle, static_cast<uint32_t>(wl.size()),
                    found.light_density, vertex.site.back});
    domain.light_density = std::max(domain.light_density, static_cast<double>(found.light_density));
  }

  const Scene& scene_;
  const SurfaceMaterial& material_;
  const CameraGrid grid_;
  const RenderOptions paths_, halves_[2];
  Progress& progress_;
  const Lighting lighting_;
  tbb::task_arena arena_;
  tbb::enumerable_thread_specific<ViewTracer> tracers_{
      [this] { return ViewTracer(scene_, material_, grid_, paths_, SceneObservation::kHits); }};
  tbb::enumerable_thread_specific<HitLightRecorder> recorders_{
      [this] { return HitLightRecorder(scene_, lighting_, halves_); }};
  SceneObservation observation_;
};

}  // namespace

void check_observer(const Scene& scene, uint32_t material, const ObserverOptions& options) {
  require_range("Observe", "width", options.width, 1, 65536);
  require_range("Observe", "height", options.height, 1, 65536);
  require_range("Observe", "bounces", options.bounces, 0, 1024);
  require_range("Observe", "threads", options.threads, 0, 4096);
  if (!scene.committed()) throw Error(Status::invalid_state, "The scene must be committed before it is observed.");
  if (material >= scene.materials().size()) {
    throw Error(Status::invalid_argument, "Material " + std::to_string(material) +
                                              " cannot be observed: the scene has only " +
                                              std::to_string(scene.materials().size()) + " materials.");
  }
}

SceneObservation observe(const Scene& scene, uint32_t material, const ObserverOptions& options, Progress& progress) {
  check_observer(scene, material, options);
  return Observer(scene, material, options, progress).run();
}

namespace {

constexpr int kProbes = 128;
constexpr int kRaysOfSide = 8;  // through the image, along each side
constexpr int kMaxHidden = 64;  // maximum number of hidden back faces that a ray passes

/// The instance whose back face a ray hits first, if it is opaque there; kNoHit: it hits something else, or nothing.
uint32_t back_met(const Scene& scene, Ray ray) {
  for (int i = 0; i < kMaxHidden; ++i) {
    Hit hit;
    scene.rays().intersect({&ray, 1}, &hit, {hidden::kFromCamera});
    if (hit.instance == kNoHit) return kNoHit;
    const SurfaceMaterial& surface = scene.materials()[scene.material(hit)];
    if (passes_back(surface, ray, hit, hidden::kFromCamera)) {
      ray.near = hit.distance * (1.0f + 1e-5f);
      continue;
    }
    const bool back = glm::dot(hit.geometric_normal, ray.direction) > 0.0f;
    const bool opaque = surface.material->opaque() && !scene.has_shell(hit);
    return back && opaque ? hit.instance : kNoHit;
  }
  return kNoHit;
}

}  // namespace

std::optional<uint32_t> surrounding_instance(const Scene& scene) {
  const Camera& camera = scene.camera();
  const Ray middle = camera.ray(Vec2(0.5f));
  const uint32_t found = back_met(scene, middle);
  if (found == kNoHit) return std::nullopt;
  for (int i = 0; i < kRaysOfSide * kRaysOfSide; ++i) {
    const Vec2 cell(static_cast<float>(i % kRaysOfSide), static_cast<float>(i / kRaysOfSide));
    if (back_met(scene, camera.ray((cell + 0.5f) / static_cast<float>(kRaysOfSide))) != found) return std::nullopt;
  }
  for (const Vec3& direction : sphere_fibonacci(kProbes)) {
    if (back_met(scene, {.origin = middle.origin, .direction = direction}) != found) return std::nullopt;
  }
  return found;
}

}  // namespace velour

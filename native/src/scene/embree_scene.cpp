#include "scene/embree_scene.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "base/parallel.h"
#include "scene/embree_meshes.h"

namespace velour {
namespace {

static_assert(RTC_INVALID_GEOMETRY_ID == kNoHit);

/// Rays passed to Embree per call, few enough for their copies to stay in the L1 cache.
constexpr size_t kRayBatch = 64;

void to_embree(const Ray& ray, uint8_t kind, RTCRay& r) {
  r.org_x = ray.origin.x;
  r.org_y = ray.origin.y;
  r.org_z = ray.origin.z;
  r.tnear = ray.near;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.time = ray.time;
  r.tfar = ray.far;
  r.mask = kind;
  r.id = 0;
  r.flags = 0;
}

}  // namespace

struct EmbreeScene::Impl {
  struct Instance {
    uint32_t mesh;
    Affine object_to_world;
    Mat3 normal_to_world;
    float front;  // -1 if mirrored, which reverses the winding in world space; else 1
    std::vector<Affine> steps;
    uint8_t hidden_from;

    bool moves() const { return !steps.empty(); }
  };

  const EmbreeApi& api = embree();
  std::shared_ptr<EmbreeMeshes> meshes = std::make_shared<EmbreeMeshes>();
  std::vector<Instance> instances;
  RTCScene top = nullptr;  // null until committed
  Levels levels = Levels::two;

  Impl() = default;
  ~Impl() { release_top(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void release_top() {
    if (top != nullptr) api.rtcReleaseScene(top);
    top = nullptr;
  }

  bool repeats_much() const {
    std::vector<bool> used(meshes->size());
    uint64_t all = 0, once = 0;
    for (const Instance& instance : instances) {
      const uint64_t triangles = meshes->triangles(instance.mesh);
      all += triangles;
      if (!used[instance.mesh]) once += triangles;
      used[instance.mesh] = true;
    }
    return static_cast<double>(all) > kMaxRepeated * static_cast<double>(once);
  }

  RTCScene build_top() const {
    RTCScene scene = meshes->new_scene();
    for (uint32_t i = 0; i < instances.size(); ++i) {
      RTCGeometry geometry = is_placed(instances[i]) ? meshes->placed(instances[i].mesh, instances[i].object_to_world)
                                                     : instance(instances[i]);
      api.rtcSetGeometryMask(geometry, ~static_cast<unsigned>(instances[i].hidden_from));
      api.rtcCommitGeometry(geometry);
      api.rtcAttachGeometryByID(scene, geometry, i);
      api.rtcReleaseGeometry(geometry);
    }
    return scene;
  }

  RTCGeometry instance(const Instance& of) const {
    RTCGeometry geometry = api.rtcNewGeometry(meshes->device(), RTC_GEOMETRY_TYPE_INSTANCE);
    api.rtcSetGeometryInstancedScene(geometry, meshes->scene(of.mesh));
    if (of.moves()) api.rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(of.steps.size()));
    api.rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, of.object_to_world.m);
    for (unsigned step = 0; step < of.steps.size(); ++step) {
      api.rtcSetGeometryTransform(geometry, step, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, of.steps[step].m);
    }
    return geometry;
  }

  /// Whether the triangles of an instance are in the top level.
  bool is_placed(const Instance& of) const { return levels == Levels::one && !of.moves(); }

  static bool goes_on(void* progress, double /*fraction*/) {
    return !static_cast<const Progress*>(progress)->cancelled();
  }

  void commit_top(int threads, const Progress* progress) const {
    RTCError error = RTC_ERROR_NONE;
    tbb::task_arena arena(arena_concurrency(threads));
    if (progress != nullptr) api.rtcSetSceneProgressMonitorFunction(top, goes_on, const_cast<Progress*>(progress));
    arena.execute([&] {  // may run on another thread, and Embree keeps errors per thread
      api.rtcJoinCommitScene(top);
      error = api.rtcGetDeviceError(meshes->device());
    });
    api.rtcSetSceneProgressMonitorFunction(top, nullptr, nullptr);
    if (progress != nullptr) progress->check();
    EmbreeMeshes::check(error);
  }

  void read_hit(const RTCRayHit& from, Hit& hit) const {
    if (from.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
      hit.instance = kNoHit;
      return;
    }
    const bool in_top = from.hit.instID[0] == RTC_INVALID_GEOMETRY_ID;
    hit.instance = in_top ? from.hit.geomID : from.hit.instID[0];
    hit.distance = from.ray.tfar;
    hit.u = from.hit.u;
    hit.v = from.hit.v;
    hit.triangle = from.hit.primID;
    hit.shell_s = std::numeric_limits<float>::quiet_NaN();
    hit.time = from.ray.time;
    const Vec3 normal(from.hit.Ng_x, from.hit.Ng_y, from.hit.Ng_z);
    const Instance& of = instances[hit.instance];
    if (in_top) {
      hit.geometric_normal = of.front * normal;
    } else {
      hit.geometric_normal = (of.moves() ? interpolated(of.steps, hit.time).normal_map() : of.normal_to_world) * normal;
    }
  }
};

EmbreeScene::EmbreeScene() : impl_(std::make_unique<Impl>()) {}
EmbreeScene::~EmbreeScene() = default;

uint32_t EmbreeScene::add_mesh(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles, unsigned steps) {
  return impl_->meshes->add(positions, triangles, steps);
}

void EmbreeScene::set_mesh(uint32_t number, std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                           unsigned steps) {
  impl_->meshes->set(number, positions, triangles, steps);
}

void EmbreeScene::share_meshes(const EmbreeScene& other) { impl_->meshes = other.impl_->meshes; }

uint32_t EmbreeScene::add_instance(uint32_t mesh, const Affine& object_to_world, std::span<const Affine> steps,
                                   uint8_t hidden_from) {
  if (mesh >= impl_->meshes->size()) {
    throw Error(Status::invalid_argument, "The instance has mesh " + std::to_string(mesh) + ", which does not exist.");
  }
  if (hidden_from != 0 && !impl_->meshes->has_masks()) {
    throw Error(Status::unsupported,
                "Embree at " + impl_->api.library.path() +
                    " was built without ray masks (EMBREE_RAY_MASK), so that nothing can be hidden "
                    "from kinds of rays. Install an Embree with ray masks, or make all objects "
                    "visible to all rays.");
  }
  const Vec3 z = glm::cross(object_to_world.column(0), object_to_world.column(1));
  const float front = glm::dot(z, object_to_world.column(2)) < 0.0f ? -1.0f : 1.0f;
  impl_->instances.push_back(
      {mesh, object_to_world, object_to_world.normal_map(), front, {steps.begin(), steps.end()}, hidden_from});
  return static_cast<uint32_t>(impl_->instances.size() - 1);
}

void EmbreeScene::clear_instances() { impl_->instances.clear(); }

void EmbreeScene::commit(int threads, const Progress* progress, Levels levels) {
  Impl& s = *impl_;
  s.release_top();
  s.levels = s.repeats_much() ? Levels::two : levels;
  std::vector<uint32_t> built;  // meshes that need hierarchies of their own
  for (const Impl::Instance& instance : s.instances) {
    if (!s.is_placed(instance)) built.push_back(instance.mesh);
  }
  s.meshes->build(built, threads, progress);
  const bool is_single = s.instances.size() == 1 && !s.instances[0].moves() && s.instances[0].hidden_from == 0;
  if (s.levels == Levels::two && is_single && s.instances[0].object_to_world == Affine{}) {
    s.levels = Levels::one;
    s.top = s.meshes->scene(s.instances[0].mesh);
    s.api.rtcRetainScene(s.top);
    return;
  }
  s.top = s.build_top();
  try {
    s.commit_top(threads, progress);
  } catch (...) {
    s.release_top();
    throw;
  }
}

EmbreeScene::Levels EmbreeScene::levels() const { return impl_->levels; }

void EmbreeScene::intersect(const Ray& ray, Hit& hit) const { intersect({&ray, 1}, &hit); }

bool EmbreeScene::occluded(const Ray& ray) const {
  uint8_t blocked;
  occluded({&ray, 1}, &blocked);
  return blocked != 0;
}

namespace {

/// Calls trace(rays, count) for each batch, converted to Embree's own rays. `kinds` is a copy: the compiler then knows
/// that the loops do not change it.
template <typename Trace>
void occluded_by_batches(std::span<const Ray> rays, uint8_t* blocked, RayKinds kinds, const Trace& trace) {
  RTCRay query[kRayBatch];
  for (size_t done = 0; done < rays.size(); done += kRayBatch) {
    const size_t count = std::min(kRayBatch, rays.size() - done);
    for (size_t i = 0; i < count; ++i) to_embree(rays[done + i], kinds[done + i], query[i]);
    trace(query, static_cast<unsigned>(count));
    for (size_t i = 0; i < count; ++i) blocked[done + i] = query[i].tfar < 0.0f;
  }
}

}  // namespace

void EmbreeScene::occluded(std::span<const Ray> rays, uint8_t* blocked, RayKinds kinds) const {
  occluded_by_batches(rays, blocked, kinds,
                      [&](RTCRay* query, unsigned count) { impl_->api.occluded(impl_->top, query, count); });
}

void EmbreeScene::occluded_coherent(std::span<const Ray> rays, uint8_t* blocked) const {
  occluded_by_batches(rays, blocked, {},
                      [&](RTCRay* query, unsigned count) { impl_->api.occluded_coherent(impl_->top, query, count); });
}

void EmbreeScene::intersect(std::span<const Ray> rays, Hit* hits, RayKinds kinds) const {
  RTCRayHit query[kRayBatch];
  for (size_t done = 0; done < rays.size(); done += kRayBatch) {
    const size_t count = std::min(kRayBatch, rays.size() - done);
    for (size_t i = 0; i < count; ++i) {
      to_embree(rays[done + i], kinds[done + i], query[i].ray);
      query[i].hit.geomID = query[i].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    impl_->api.intersect(impl_->top, query, static_cast<unsigned>(count));
    for (size_t i = 0; i < count; ++i) impl_->read_hit(query[i], hits[done + i]);
  }
}

uint64_t EmbreeScene::bytes() const { return static_cast<uint64_t>(std::max<int64_t>(0, impl_->meshes->bytes())); }

EmbreeInfo embree_info() {
  const EmbreeApi& api = embree();
  RTCDevice device = api.new_device();
  const auto version = api.rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION);
  api.rtcReleaseDevice(device);
  return {
      std::to_string(version / 10000) + "." + std::to_string(version / 100 % 100) + "." + std::to_string(version % 100),
      api.library.path()};
}

void embree_self_test() {
  const EmbreeInfo info = embree_info();
  if (info.version != RTC_VERSION_STRING) {
    throw Error(Status::version_mismatch, "Embree at " + info.path + " is version " + info.version +
                                              ", but Velour was built for " + RTC_VERSION_STRING +
                                              ". Install that version, or rebuild Velour.");
  }
  EmbreeScene scene;
  const Vec3 positions[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const glm::uvec3 triangle[] = {{0, 1, 2}};
  scene.add_instance(scene.add_mesh(positions, triangle), {});
  scene.commit(1);
  Hit hit;
  scene.intersect({{0.25f, 0.5f, 2}, 0, {0, 0, -1}}, hit);
  const bool right = hit.instance == 0 && std::abs(hit.distance - 2) < 1e-5f && hit.geometric_normal.z > 0 &&
                     std::abs(hit.u - 0.25f) < 1e-5f && std::abs(hit.v - 0.5f) < 1e-5f;
  if (!right || scene.occluded({{1, 1, 2}, 0, {0, 0, -1}})) {
    throw Error(Status::version_mismatch,
                "Embree at " + info.path +
                    " does not work: its self test misses a triangle. Another copy of Embree may be loaded instead.");
  }
}

}  // namespace velour

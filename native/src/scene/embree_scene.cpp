#include "scene/embree_scene.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <utility>
#include <vector>

#include "job/error.h"
#include "job/threads.h"
#include "scene/embree_api.h"

namespace velour {
namespace {

static_assert(RTC_INVALID_GEOMETRY_ID == kNoHit);

bool count_bytes(void* counter, ssize_t bytes, bool /*post*/) {
  static_cast<std::atomic<int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

/// Rays handed to Embree at once: their copies stay in the first-level cache.
constexpr size_t kBatch = 64;

void to_embree(const Ray& ray, RTCRay& r) {
  r.org_x = ray.origin.x;
  r.org_y = ray.origin.y;
  r.org_z = ray.origin.z;
  r.tnear = ray.near;
  r.dir_x = ray.direction.x;
  r.dir_y = ray.direction.y;
  r.dir_z = ray.direction.z;
  r.time = 0.0f;
  r.tfar = ray.far;
  r.mask = ~0u;
  r.id = 0;
  r.flags = 0;
}

}  // namespace

/// Meshes with their hierarchies: what several scenes may share.
struct EmbreeScene::Meshes {
  const EmbreeApi& api = embree();
  std::atomic<int64_t> bytes{0};
  RTCDevice device = nullptr;
  std::vector<RTCScene> scenes;
  std::vector<uint32_t> unbuilt;  // of them, by number

  Meshes() : device(api.rtcNewDevice(nullptr)) {
    if (device == nullptr) throw Error(Status::unsupported, "Embree cannot run on this processor.");
    api.rtcSetDeviceMemoryMonitorFunction(device, count_bytes, &bytes);
  }
  ~Meshes() {
    for (RTCScene mesh : scenes) api.rtcReleaseScene(mesh);
    api.rtcReleaseDevice(device);
  }
  Meshes(const Meshes&) = delete;
  Meshes& operator=(const Meshes&) = delete;

  void build(tbb::task_arena& arena) {
    arena.execute([this] {
      for (uint32_t number : unbuilt) api.rtcJoinCommitScene(scenes[number]);
    });
    unbuilt.clear();
  }
};

struct EmbreeScene::Impl {
  struct Instance {
    uint32_t mesh;
    Affine object_to_world;
    Mat3 normal_to_world;
  };

  const EmbreeApi& api = embree();
  std::shared_ptr<Meshes> meshes = std::make_shared<Meshes>();
  std::vector<Instance> instances;
  RTCScene top = nullptr;     // instances; stays null when `traced` is the only mesh itself
  RTCScene traced = nullptr;  // null until committed

  Impl() = default;
  ~Impl() { release_top(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void release_top() {
    if (top != nullptr) api.rtcReleaseScene(top);
    top = nullptr;
    traced = nullptr;
  }

  RTCScene new_scene() const {
    RTCScene scene = api.rtcNewScene(meshes->device);
    api.rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    return scene;
  }

  void attach(RTCScene scene, RTCGeometry geometry, uint32_t id) const {
    api.rtcCommitGeometry(geometry);
    api.rtcAttachGeometryByID(scene, geometry, id);
    api.rtcReleaseGeometry(geometry);
  }

  RTCScene build_top() const {
    RTCScene scene = new_scene();
    for (uint32_t i = 0; i < instances.size(); ++i) {
      RTCGeometry geometry = api.rtcNewGeometry(meshes->device, RTC_GEOMETRY_TYPE_INSTANCE);
      api.rtcSetGeometryInstancedScene(geometry, meshes->scenes[instances[i].mesh]);
      api.rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, instances[i].object_to_world.m);
      attach(scene, geometry, i);
    }
    return scene;
  }

  /// Of a mesh, not committed.
  RTCScene mesh_scene(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles) const {
    for (const glm::uvec3& t : triangles) {
      if (std::max({t.x, t.y, t.z}) >= positions.size()) {
        throw Error(Status::invalid_argument, "A triangle names vertex " + std::to_string(std::max({t.x, t.y, t.z})) +
                                                  " of a mesh with " + std::to_string(positions.size()) + ".");
      }
    }
    RTCGeometry geometry = api.rtcNewGeometry(meshes->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!triangles.empty()) {
      void* vertex = api.rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                                 positions.size());
      void* index = api.rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                sizeof(glm::uvec3), triangles.size());
      check();
      std::memcpy(vertex, positions.data(), positions.size_bytes());
      std::memcpy(index, triangles.data(), triangles.size_bytes());
    }
    RTCScene scene = new_scene();
    attach(scene, geometry, 0);
    return scene;
  }

  void check() const {
    const RTCError error = api.rtcGetDeviceError(meshes->device);
    if (error == RTC_ERROR_NONE) return;
    if (error == RTC_ERROR_OUT_OF_MEMORY) {
      throw Error(Status::out_of_memory, "Not enough memory to build the ray tracer's hierarchy.");
    }
    throw Error(Status::unknown, "Embree failed with its error " + std::to_string(error) + ".");
  }

  void read_hit(const RTCRayHit& from, Hit& hit) const {
    if (from.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
      hit.instance = kNoHit;
      return;
    }
    hit.instance = top == nullptr ? 0 : from.hit.instID[0];
    hit.distance = from.ray.tfar;
    hit.u = from.hit.u;
    hit.v = from.hit.v;
    hit.triangle = from.hit.primID;
    hit.shell_s = std::numeric_limits<float>::quiet_NaN();
    hit.geometric_normal = {from.hit.Ng_x, from.hit.Ng_y, from.hit.Ng_z};
    if (top != nullptr) hit.geometric_normal = instances[hit.instance].normal_to_world * hit.geometric_normal;
  }
};

EmbreeScene::EmbreeScene() : impl_(std::make_unique<Impl>()) {}
EmbreeScene::~EmbreeScene() = default;

uint32_t EmbreeScene::add_mesh(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles) {
  Meshes& meshes = *impl_->meshes;
  meshes.scenes.push_back(impl_->mesh_scene(positions, triangles));
  meshes.unbuilt.push_back(static_cast<uint32_t>(meshes.scenes.size() - 1));
  return meshes.unbuilt.back();
}

void EmbreeScene::set_mesh(uint32_t number, std::span<const Vec3> positions, std::span<const glm::uvec3> triangles) {
  Meshes& meshes = *impl_->meshes;
  RTCScene scene = impl_->mesh_scene(positions, triangles);
  impl_->api.rtcReleaseScene(std::exchange(meshes.scenes.at(number), scene));
  meshes.unbuilt.push_back(number);
}

void EmbreeScene::share_meshes(const EmbreeScene& other) { impl_->meshes = other.impl_->meshes; }

uint32_t EmbreeScene::add_instance(uint32_t mesh, const Affine& object_to_world) {
  if (mesh >= impl_->meshes->scenes.size()) {
    throw Error(Status::invalid_argument, "There is no mesh " + std::to_string(mesh) + " to instance.");
  }
  impl_->instances.push_back({mesh, object_to_world, object_to_world.normal_map()});
  return static_cast<uint32_t>(impl_->instances.size() - 1);
}

void EmbreeScene::clear_instances() { impl_->instances.clear(); }

void EmbreeScene::commit(int threads) {
  Impl& s = *impl_;
  s.release_top();
  tbb::task_arena arena(arena_concurrency(threads));
  s.meshes->build(arena);
  const bool direct = s.instances.size() == 1 && s.instances[0].object_to_world == Affine{};
  if (!direct) {
    s.top = s.build_top();
    arena.execute([&s] { s.api.rtcJoinCommitScene(s.top); });
  }
  s.check();
  s.traced = direct ? s.meshes->scenes[s.instances[0].mesh] : s.top;
}

void EmbreeScene::intersect(const Ray& ray, Hit& hit) const { intersect({&ray, 1}, &hit); }

bool EmbreeScene::occluded(const Ray& ray) const {
  uint8_t blocked;
  occluded({&ray, 1}, &blocked);
  return blocked != 0;
}

namespace {

/// `trace` gets a batch of Embree's own rays.
template <typename Trace>
void occluded_by_batches(std::span<const Ray> rays, uint8_t* blocked, const Trace& trace) {
  RTCRay query[kBatch];
  for (size_t done = 0; done < rays.size(); done += kBatch) {
    const size_t count = std::min(kBatch, rays.size() - done);
    for (size_t i = 0; i < count; ++i) to_embree(rays[done + i], query[i]);
    trace(query, static_cast<unsigned>(count));
    for (size_t i = 0; i < count; ++i) blocked[done + i] = query[i].tfar < 0.0f;
  }
}

}  // namespace

void EmbreeScene::occluded(std::span<const Ray> rays, uint8_t* blocked) const {
  occluded_by_batches(rays, blocked,
                      [&](RTCRay* query, unsigned count) { impl_->api.occluded(impl_->traced, query, count); });
}

void EmbreeScene::occluded_coherent(std::span<const Ray> rays, uint8_t* blocked) const {
  occluded_by_batches(
      rays, blocked, [&](RTCRay* query, unsigned count) { impl_->api.occluded_coherent(impl_->traced, query, count); });
}

void EmbreeScene::intersect(std::span<const Ray> rays, Hit* hits) const {
  RTCRayHit query[kBatch];
  for (size_t done = 0; done < rays.size(); done += kBatch) {
    const size_t count = std::min(kBatch, rays.size() - done);
    for (size_t i = 0; i < count; ++i) {
      to_embree(rays[done + i], query[i].ray);
      query[i].hit.geomID = RTC_INVALID_GEOMETRY_ID;
    }
    impl_->api.intersect(impl_->traced, query, static_cast<unsigned>(count));
    for (size_t i = 0; i < count; ++i) impl_->read_hit(query[i], hits[done + i]);
  }
}

uint64_t EmbreeScene::bytes() const {
  return static_cast<uint64_t>(std::max<int64_t>(0, impl_->meshes->bytes.load(std::memory_order_relaxed)));
}

EmbreeInfo embree_info() {
  const EmbreeApi& api = embree();
  RTCDevice device = api.rtcNewDevice(nullptr);
  if (device == nullptr) throw Error(Status::unsupported, "Embree cannot run on this processor.");
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
                                              ": install that version, or rebuild Velour.");
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
                "Embree at " + info.path + " misses a known triangle: another copy of it may be in the way.");
  }
}

}  // namespace velour

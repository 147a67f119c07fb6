#include "scene/embree_meshes.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"

namespace velour {
namespace {

/// Interval between checks for a cancel while waiting for a build.
constexpr std::chrono::milliseconds kTurn{2};

bool count_bytes(void* counter, ssize_t bytes, bool /*post*/) {
  static_cast<std::atomic<int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

}  // namespace

/// Builds scenes one after the other on a thread of its own.
class EmbreeMeshes::Build {
 public:
  Build(RTCDevice device, const std::vector<RTCScene>& scenes, int threads) : device_(device), threads_(threads) {
    for (RTCScene scene : scenes) items_.emplace_back(scene);
    try {
      thread_ = std::thread(&Build::run, this);
    } catch (const std::system_error&) {
      throw Error(Status::out_of_memory,
                  "The system could not start a thread to build the BVH. Close other programs and try again.");
    }
    for (RTCScene scene : scenes) api_.rtcRetainScene(scene);
  }
  ~Build() {
    keep({});
    join();
    for (const Item& item : items_) api_.rtcReleaseScene(item.scene);
  }
  Build(const Build&) = delete;
  Build& operator=(const Build&) = delete;

  /// Cancels the builds of all scenes that are not in `scenes`.
  void keep(const std::vector<RTCScene>& scenes) {
    for (Item& item : items_) item.is_dropped = std::ranges::find(scenes, item.scene) == scenes.end();
  }
  bool ends_within(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, time, [this] { return has_ended_; });
  }
  void join() {
    if (thread_.joinable()) thread_.join();
  }
  /// Valid after join().
  RTCError error() const { return error_; }
  bool has_built(RTCScene scene) const {
    return std::ranges::any_of(items_, [scene](const Item& i) { return i.scene == scene && i.is_built; });
  }

 private:
  struct Item {
    explicit Item(RTCScene of) : scene(of) {}
    RTCScene scene;
    std::atomic<bool> is_dropped{false};
    bool is_built = false;
  };

  static bool goes_on(void* item, double /*fraction*/) { return !static_cast<const Item*>(item)->is_dropped; }

  void run() {
    tbb::task_arena arena(arena_concurrency(threads_));
    for (Item& item : items_) {
      if (item.is_dropped) continue;
      const RTCError error = commit(item, arena);
      item.is_built = error == RTC_ERROR_NONE;
      if (item.is_built || error == RTC_ERROR_CANCELLED) continue;
      error_ = error;
      break;
    }
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    ended_.notify_all();
  }

  RTCError commit(Item& item, tbb::task_arena& arena) const {
    RTCError error = RTC_ERROR_NONE;
    arena.execute([&] {  // may run on another thread, and Embree keeps errors per thread
      api_.rtcSetSceneProgressMonitorFunction(item.scene, goes_on, &item);
      api_.rtcJoinCommitScene(item.scene);
      api_.rtcSetSceneProgressMonitorFunction(item.scene, nullptr, nullptr);
      error = api_.rtcGetDeviceError(device_);
    });
    return error;
  }

  const EmbreeApi& api_ = embree();
  RTCDevice device_;
  int threads_;
  std::deque<Item> items_;
  RTCError error_ = RTC_ERROR_NONE;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::thread thread_;
};

EmbreeMeshes::EmbreeMeshes() : device_(api_.new_device()) {
  api_.rtcSetDeviceMemoryMonitorFunction(device_, count_bytes, &bytes_);
  has_masks_ = api_.rtcGetDeviceProperty(device_, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) != 0;
}

EmbreeMeshes::~EmbreeMeshes() {
  build_.reset();
  for (RTCScene scene : scenes_) api_.rtcReleaseScene(scene);
  api_.rtcReleaseDevice(device_);
}

uint32_t EmbreeMeshes::add(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles, unsigned steps) {
  scenes_.push_back(scene_of(positions, triangles, steps));
  sizes_.push_back({positions.size() / steps, triangles.size(), steps});
  unbuilt_.push_back(static_cast<uint32_t>(scenes_.size() - 1));
  return unbuilt_.back();
}

void EmbreeMeshes::set(uint32_t number, std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                       unsigned steps) {
  RTCScene fresh = scene_of(positions, triangles, steps);
  api_.rtcReleaseScene(std::exchange(scenes_.at(number), fresh));
  sizes_[number] = {positions.size() / steps, triangles.size(), steps};
  if (std::ranges::find(unbuilt_, number) == unbuilt_.end()) unbuilt_.push_back(number);
}

void EmbreeMeshes::build(std::span<const uint32_t> numbers, int threads, const Progress* progress) {
  std::unique_lock lock(building_, std::defer_lock);
  while (!lock.try_lock_for(kTurn)) {
    if (progress != nullptr) progress->check();
  }
  if (build_) {
    build_->keep(unbuilt_scenes(numbers));
    await(progress);
  }
  const std::vector<RTCScene> scenes = unbuilt_scenes(numbers);
  if (scenes.empty()) return;
  build_ = std::make_unique<Build>(device_, scenes, threads);
  await(progress);
}

std::vector<RTCScene> EmbreeMeshes::unbuilt_scenes(std::span<const uint32_t> numbers) const {
  std::vector<bool> wanted(scenes_.size());
  for (const uint32_t number : numbers) wanted.at(number) = true;
  std::vector<RTCScene> scenes;
  for (const uint32_t number : unbuilt_) {
    if (wanted[number]) scenes.push_back(scenes_[number]);
  }
  return scenes;
}

RTCGeometry EmbreeMeshes::geometry_of(uint32_t number) const {
  const std::lock_guard lock(handles_);
  return api_.rtcGetGeometry(scenes_.at(number), 0);
}

RTCGeometry EmbreeMeshes::placed(uint32_t number, const Affine& place) const {
  RTCGeometry mesh = geometry_of(number);
  RTCGeometry geometry = api_.rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  const auto [vertices, triangles, steps] = sizes_[number];
  if (triangles == 0) return geometry;
  api_.rtcSetGeometryTimeStepCount(geometry, steps);
  for (unsigned step = 0; step < steps; ++step) {
    auto* to = static_cast<Vec3*>(api_.rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step,
                                                               RTC_FORMAT_FLOAT3, sizeof(Vec3), vertices));
    check(api_.rtcGetDeviceError(device_));
    const auto* from = static_cast<const Vec3*>(api_.rtcGetGeometryBufferData(mesh, RTC_BUFFER_TYPE_VERTEX, step));
    std::transform(from, from + vertices, to, [&](const Vec3& p) { return place.point(p); });
  }
  api_.rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                  api_.rtcGetGeometryBufferData(mesh, RTC_BUFFER_TYPE_INDEX, 0), 0, sizeof(glm::uvec3),
                                  triangles);
  return geometry;
}

void EmbreeMeshes::await(const Progress* progress) {
  do {
    if (progress != nullptr) progress->check();  // first, because a build may end within one interval
  } while (!build_->ends_within(kTurn));
  build_->join();
  const RTCError error = build_->error();
  std::erase_if(unbuilt_, [&](uint32_t number) { return build_->has_built(scenes_[number]); });
  build_.reset();
  if (error == RTC_ERROR_NONE) return;
  for (uint32_t number : unbuilt_) renew(scenes_[number]);
  check(error);
}

RTCScene EmbreeMeshes::new_scene() const {
  RTCScene scene = api_.rtcNewScene(device_);
  api_.rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
  return scene;
}

RTCScene EmbreeMeshes::scene_of(std::span<const Vec3> positions, std::span<const glm::uvec3> triangles,
                                unsigned steps) const {
  const size_t vertices = positions.size() / steps;
  for (const glm::uvec3& t : triangles) {
    if (std::max({t.x, t.y, t.z}) >= vertices) {
      throw Error(Status::invalid_argument, "A triangle has vertex index " + std::to_string(std::max({t.x, t.y, t.z})) +
                                                ", but the mesh has only " + std::to_string(vertices) + " vertices.");
    }
  }
  RTCGeometry geometry = api_.rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  if (!triangles.empty()) {
    api_.rtcSetGeometryTimeStepCount(geometry, steps);
    for (unsigned step = 0; step < steps; ++step) {
      void* vertex = api_.rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3,
                                                  sizeof(Vec3), vertices);
      check(api_.rtcGetDeviceError(device_));
      std::memcpy(vertex, positions.data() + step * vertices, vertices * sizeof(Vec3));
    }
    void* index = api_.rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3),
                                               triangles.size());
    check(api_.rtcGetDeviceError(device_));
    std::memcpy(index, triangles.data(), triangles.size_bytes());
  }
  // Rays of all kinds hit the mesh: instances hide. The default differs between Embree 3 and 4.
  api_.rtcSetGeometryMask(geometry, ~0u);
  RTCScene scene = new_scene();
  api_.rtcCommitGeometry(geometry);
  api_.rtcAttachGeometryByID(scene, geometry, 0);
  api_.rtcReleaseGeometry(geometry);
  return scene;
}

/// Replaces a scene whose build has failed: Embree does not specify what building it again does.
void EmbreeMeshes::renew(RTCScene& scene) {
  const std::lock_guard lock(handles_);
  RTCScene fresh = new_scene();
  api_.rtcAttachGeometryByID(fresh, api_.rtcGetGeometry(scene, 0), 0);
  api_.rtcReleaseScene(std::exchange(scene, fresh));
}

void EmbreeMeshes::check(RTCError error) {
  if (error == RTC_ERROR_NONE) return;
  if (error == RTC_ERROR_OUT_OF_MEMORY) {
    throw Error(Status::out_of_memory,
                "Not enough memory to build the BVH. Simplify the scene, or close other programs.");
  }
  throw Error(Status::unknown, "Embree failed with error code " + std::to_string(error) + ".");
}

}  // namespace velour

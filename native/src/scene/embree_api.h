// Embree's entry points, bound with dlsym. Included by embree_*.cpp only; nothing else sees Embree.
#pragma once

#if VELOUR_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "base/error.h"
#include "base/private_library.h"

namespace velour {

/// Table of the functions in use. Their types come from Embree's headers, so a mismatch is a compile error.
struct EmbreeApi {
  PrivateLibrary library{
      "libembree" + std::to_string(RTC_VERSION_MAJOR) + ".so." + std::to_string(RTC_VERSION_MAJOR),
      "install Embree " + std::string(RTC_VERSION_STRING) + ", or put its library next to Velour's."};
#define VELOUR_EMBREE(name) decltype(::name)* name = library.function<decltype(::name)>(#name)
  VELOUR_EMBREE(rtcNewDevice);
  VELOUR_EMBREE(rtcReleaseDevice);
  VELOUR_EMBREE(rtcGetDeviceProperty);
  VELOUR_EMBREE(rtcGetDeviceError);
  VELOUR_EMBREE(rtcSetDeviceMemoryMonitorFunction);
  VELOUR_EMBREE(rtcNewScene);
  VELOUR_EMBREE(rtcRetainScene);
  VELOUR_EMBREE(rtcReleaseScene);
  VELOUR_EMBREE(rtcSetSceneFlags);
  VELOUR_EMBREE(rtcSetSceneProgressMonitorFunction);
  VELOUR_EMBREE(rtcSetSceneBuildQuality);
  VELOUR_EMBREE(rtcJoinCommitScene);
  VELOUR_EMBREE(rtcNewGeometry);
  VELOUR_EMBREE(rtcReleaseGeometry);
  VELOUR_EMBREE(rtcCommitGeometry);
  VELOUR_EMBREE(rtcAttachGeometryByID);
  VELOUR_EMBREE(rtcGetGeometry);
  VELOUR_EMBREE(rtcSetNewGeometryBuffer);
  VELOUR_EMBREE(rtcSetSharedGeometryBuffer);
  VELOUR_EMBREE(rtcGetGeometryBufferData);
  VELOUR_EMBREE(rtcSetGeometryInstancedScene);
  VELOUR_EMBREE(rtcSetGeometryTransform);
  VELOUR_EMBREE(rtcSetGeometryTimeStepCount);
  VELOUR_EMBREE(rtcSetGeometryMask);
#if VELOUR_EMBREE_MAJOR >= 4
  VELOUR_EMBREE(rtcIntersect1);
  VELOUR_EMBREE(rtcOccluded1);
  VELOUR_EMBREE(rtcOccluded8);
#else
  VELOUR_EMBREE(rtcIntersect1M);
  VELOUR_EMBREE(rtcOccluded1M);
#endif
#undef VELOUR_EMBREE

  /// A device, which the caller releases. Throws with the reason why there is none.
  RTCDevice new_device() const {
    RTCDevice device = rtcNewDevice(nullptr);
    if (device != nullptr) return device;
    switch (rtcGetDeviceError(nullptr)) {
      case RTC_ERROR_UNSUPPORTED_CPU:
        throw Error(Status::unsupported, "Embree does not support this processor.");
      default:  // also "unknown" where its threads cannot start
        throw Error(Status::out_of_memory,
                    "Embree cannot start, as there is no memory left for its threads; free memory, or raise the limit "
                    "of the process (ulimit -v, ulimit -u).");
    }
  }

  // Embree 3 takes a context, Embree 4 optional arguments at the end. All differences between them are confined here.
  //
  // Batches: every ray takes the single-ray path through the hierarchy, so its hit does not depend on its neighbors.
  // Embree 3's stream call does the same for incoherent rays without the cost of one call per ray: 10.7 million
  // hemisphere shadow rays per second on a bunny of 69 thousand triangles, against 7.0 for rtcOccluded1, 8.5 and 8.9
  // for packets of 8 and 16, and 5.2 for the coherent stream (3.13.5, AVX-512, one thread).
#if VELOUR_EMBREE_MAJOR >= 4
  void intersect(RTCScene scene, RTCRayHit* rays, unsigned count) const {
    for (unsigned i = 0; i < count; ++i) rtcIntersect1(scene, rays + i, nullptr);
  }
  void occluded(RTCScene scene, RTCRay* rays, unsigned count) const {
    for (unsigned i = 0; i < count; ++i) rtcOccluded1(scene, rays + i, nullptr);
  }
  // Embree 4 has no streams. Packets of 8 with this flag trace 11 million rays per second over a tile of 33 thousand
  // triangles repeated by instances, single rays 5.7, packets of 16 11.7 (4.3.3, AVX-512, one thread). With AVX2,
  // packets of 8 reach 10.7 and packets of 16 are no faster than single rays. Without AVX all are alike.
  void occluded_coherent(RTCScene scene, RTCRay* rays, unsigned count) const {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    for (; count > kLanes; count -= kLanes, rays += kLanes) occluded_packet(scene, rays, kLanes, &arguments);
    occluded_packet(scene, rays, count, &arguments);
  }

 private:
  static constexpr unsigned kLanes = 8;

  void occluded_packet(RTCScene scene, RTCRay* rays, unsigned count, RTCOccludedArguments* arguments) const {
    alignas(32) int valid[kLanes] = {};
    RTCRay8 packet{};
    for (unsigned i = 0; i < count; ++i) {
      valid[i] = -1;
      packet.org_x[i] = rays[i].org_x;
      packet.org_y[i] = rays[i].org_y;
      packet.org_z[i] = rays[i].org_z;
      packet.tnear[i] = rays[i].tnear;
      packet.dir_x[i] = rays[i].dir_x;
      packet.dir_y[i] = rays[i].dir_y;
      packet.dir_z[i] = rays[i].dir_z;
      packet.tfar[i] = rays[i].tfar;
      packet.mask[i] = rays[i].mask;
      packet.time[i] = rays[i].time;
    }
    rtcOccluded8(valid, scene, &packet, arguments);
    for (unsigned i = 0; i < count; ++i) rays[i].tfar = packet.tfar[i];
  }
#else
  struct Context : RTCIntersectContext {
    Context() { rtcInitIntersectContext(this); }
  };
  void intersect(RTCScene scene, RTCRayHit* rays, unsigned count) const {
    Context context;
    rtcIntersect1M(scene, &context, rays, count, sizeof(RTCRayHit));
  }
  void occluded(RTCScene scene, RTCRay* rays, unsigned count) const {
    Context context;
    rtcOccluded1M(scene, &context, rays, count, sizeof(RTCRay));
  }
  // Parallel rays with nearby origins, whose packets follow one path through the hierarchy. Over a tile of 32 thousand
  // triangles repeated by instances: 20 to 30 million rays per second from the first hits of adjacent texels, against 7
  // for the other stream and 20 to 29 for rtcOccluded16 with this flag (without it, 3.13.5 never returns from a scene
  // with instances); 10 to 11 million from hits of the next bounce in spatial order, against 5.5.
  void occluded_coherent(RTCScene scene, RTCRay* rays, unsigned count) const {
    Context context;
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded1M(scene, &context, rays, count, sizeof(RTCRay));
  }
#endif
};

/// Loads Embree at the first call. Throws Error if it is missing.
inline const EmbreeApi& embree() {
  static const EmbreeApi api;
  return api;
}

}  // namespace velour

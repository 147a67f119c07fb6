// Embree's entry points, bound by dlsym. Included by embree_*.cpp alone: nothing else sees Embree.
#pragma once

#if VELOUR_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "file/private_library.h"

namespace velour {

/// Table of the functions we use. Their types come from the headers, so a mismatch is a compile error.
struct EmbreeApi {
  PrivateLibrary library{"libembree" + std::to_string(RTC_VERSION_MAJOR) + ".so." + std::to_string(RTC_VERSION_MAJOR),
                         "install Embree " + std::string(RTC_VERSION_STRING) + " or put its library beside Velour's."};
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
#if VELOUR_EMBREE_MAJOR >= 4
  VELOUR_EMBREE(rtcIntersect1);
  VELOUR_EMBREE(rtcOccluded1);
  VELOUR_EMBREE(rtcOccluded8);
#else
  VELOUR_EMBREE(rtcIntersect1M);
  VELOUR_EMBREE(rtcOccluded1M);
#endif
#undef VELOUR_EMBREE

  // Embree 3 takes a context, Embree 4 optional arguments at the end: the whole difference is here.
  //
  // Batches: every ray takes the single-ray path through the hierarchy, so what it meets does not depend on its
  // neighbours. Embree 3's stream call does just that for incoherent rays, without the cost of a call a ray: 10.7
  // million hemisphere shadow rays a second on a bunny of 69 thousand triangles, against 7.0 for rtcOccluded1, 8.5 and
  // 8.9 for packets of 8 and 16, 5.2 for the coherent stream (3.13.5, AVX-512, one thread).
#if VELOUR_EMBREE_MAJOR >= 4
  void intersect(RTCScene scene, RTCRayHit* rays, unsigned count) const {
    for (unsigned i = 0; i < count; ++i) rtcIntersect1(scene, rays + i, nullptr);
  }
  void occluded(RTCScene scene, RTCRay* rays, unsigned count) const {
    for (unsigned i = 0; i < count; ++i) rtcOccluded1(scene, rays + i, nullptr);
  }
  // Embree 4 has no streams. Packets of 8 with this flag: 11 million a second over a tile of 33 thousand triangles
  // repeated by instances, against 5.7 for single rays and 11.7 for packets of 16, which are no faster than single rays
  // with AVX2, where those of 8 make 10.7 (4.3.3, AVX-512, one thread). Without AVX all are alike.
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
  // Parallel rays from places near each other, whose packets follow one path through the hierarchy. Over a tile of 32
  // thousand triangles repeated by instances: 20 to 30 million a second from neighbouring texels' first hits, where the
  // other stream makes 7 and rtcOccluded16 with this flag 20 to 29 (without it, 3.13.5 never returns from a scene of
  // instances); 10 to 11 from hits of the next bounce in the order of their places, against 5.5.
  void occluded_coherent(RTCScene scene, RTCRay* rays, unsigned count) const {
    Context context;
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded1M(scene, &context, rays, count, sizeof(RTCRay));
  }
#endif
};

/// Loaded at the first call; throws Error when Embree is missing.
inline const EmbreeApi& embree() {
  static const EmbreeApi api;
  return api;
}

}  // namespace velour

// Embree's entry points, bound by dlsym. Included by embree_scene.cpp alone: nothing else sees Embree.
#pragma once

#if VELOUR_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "scene/private_library.h"

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
  VELOUR_EMBREE(rtcReleaseScene);
  VELOUR_EMBREE(rtcSetSceneFlags);
  VELOUR_EMBREE(rtcSetSceneBuildQuality);
  VELOUR_EMBREE(rtcJoinCommitScene);
  VELOUR_EMBREE(rtcNewGeometry);
  VELOUR_EMBREE(rtcReleaseGeometry);
  VELOUR_EMBREE(rtcCommitGeometry);
  VELOUR_EMBREE(rtcAttachGeometryByID);
  VELOUR_EMBREE(rtcSetNewGeometryBuffer);
  VELOUR_EMBREE(rtcSetGeometryInstancedScene);
  VELOUR_EMBREE(rtcSetGeometryTransform);
  VELOUR_EMBREE(rtcIntersect1);
  VELOUR_EMBREE(rtcOccluded1);
#undef VELOUR_EMBREE

  // Embree 3 takes a context, Embree 4 optional arguments at the end: the whole difference is here.
#if VELOUR_EMBREE_MAJOR >= 4
  void intersect(RTCScene scene, RTCRayHit& ray) const { rtcIntersect1(scene, &ray, nullptr); }
  void occluded(RTCScene scene, RTCRay& ray) const { rtcOccluded1(scene, &ray, nullptr); }
#else
  struct Context : RTCIntersectContext {
    Context() { rtcInitIntersectContext(this); }
  };
  void intersect(RTCScene scene, RTCRayHit& ray) const {
    Context context;
    rtcIntersect1(scene, &context, &ray);
  }
  void occluded(RTCScene scene, RTCRay& ray) const {
    Context context;
    rtcOccluded1(scene, &context, &ray);
  }
#endif
};

/// Loaded at the first call; throws Error when Embree is missing.
inline const EmbreeApi& embree() {
  static const EmbreeApi api;
  return api;
}

}  // namespace velour

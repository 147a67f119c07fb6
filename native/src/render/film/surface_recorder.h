// Values of the surface passes at the first surface that a camera ray hits.
#pragma once

#include "material/material.h"
#include "render/film/camera_sample.h"
#include "render/film/pass_layout.h"
#include "render/path_numbers.h"
#include "render/vertex.h"

namespace velour {

// Albedo: share of light that a surface reflects toward the viewer.

/// Holds scratch memory; one per thread.
class SurfaceAlbedo {
 public:
  explicit SurfaceAlbedo(const std::optional<Mat3>& rec709_to_working) : rec709_to_working_(rec709_to_working) {}

  /// Unbiased estimate of the integral of f cos over the sphere, in the working space, from kDirections directions
  /// sampled by the material; may be above 1. Excludes emission.
  Rgb estimate(const Vertex& vertex, PathNumbers numbers);

 private:
  static constexpr int kDirections = 4;

  const std::optional<Mat3>& rec709_to_working_;
  ScratchArena arena_;
  DirectionBatch drawn_, wl_;
  RgbBatch f_;
  ScalarBatch pdf_;
};

/// Holds scratch memory; one per thread.
class SurfaceRecorder {
 public:
  /// `width`, `height`: of the image in pixels.
  SurfaceRecorder(const Scene& scene, int width, int height)
      : scene_(scene),
        albedo_(scene.rec709_to_working()),
        size_(static_cast<float>(width), static_cast<float>(height)),
        previous_(scene.camera(), 0.0f),
        current_(scene.camera(), kMiddleTime),
        next_(scene.camera(), 1.0f) {}

  /// `vertex`: at `hit`, which a ray reached with throughput `throughput`. `numbers`: of its path.
  SurfaceSample record(const PassOptions& options, const Vertex& vertex, const Hit& hit, const Rgb& throughput,
                       const PathNumbers& numbers);

 private:
  /// Texture coordinates of a set of the mesh, not placed by any material.
  Vec3 uv(const Hit& hit, int set) const;
  float distance(const Vec3& world) const;
  void find_motion(const Hit& hit, SurfaceSample& sample) const;

  const Scene& scene_;
  SurfaceAlbedo albedo_;
  Vec2 size_;
  CameraProjection previous_, current_, next_;
};

}  // namespace velour

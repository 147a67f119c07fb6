// Values of the surface passes at the first surface that a camera ray hits.
#pragma once

#include "render/camera_sample.h"
#include "render/pass_options.h"
#include "render/surface_albedo.h"

namespace velour {

/// Holds scratch memory; one per thread.
class SurfaceRecorder {
 public:
  explicit SurfaceRecorder(const Scene& scene) : scene_(scene), albedo_(scene.rec709_to_working()) {}

  /// `vertex`: at `hit`, which a ray reached with throughput `throughput`. `numbers`: of its path.
  SurfaceSample record(const PassOptions& options, const Vertex& vertex, const Hit& hit, const Rgb& throughput,
                       const PathNumbers& numbers);

 private:
  /// Texture coordinates of a set of the mesh, not placed by any material.
  Vec3 uv(const Hit& hit, int set) const;
  float distance(const Vec3& world) const;

  const Scene& scene_;
  SurfaceAlbedo albedo_;
};

}  // namespace velour

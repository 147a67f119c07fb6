// What the passes of surfaces say of the first thing that a camera ray meets.
#pragma once

#include "render/camera_sample.h"
#include "render/pass_options.h"
#include "render/surface_albedo.h"

namespace velour {

/// Scratch memory of one thread.
class SurfaceRecorder {
 public:
  explicit SurfaceRecorder(const Scene& scene) : scene_(scene), albedo_(scene.rec709_to_working()) {}

  /// `vertex`: of `hit`, by a ray that has come to it with `throughput` left. `numbers`: of its path.
  SurfaceSample record(const PassOptions& options, const Vertex& vertex, const Hit& hit, const Rgb& throughput,
                       const PathNumbers& numbers);

 private:
  /// Of a set of the mesh, as it is: no material places it.
  Vec3 uv(const Hit& hit, int set) const;
  float distance(const Vec3& world) const;

  const Scene& scene_;
  SurfaceAlbedo albedo_;
};

}  // namespace velour

// The ray with which a path goes on from a surface.
#pragma once

#include <optional>

#include "render/direction_sampling.h"

namespace velour {

struct Continuation {
  Ray ray;
  Rgb throughput;
  Vec3 wl;        // local
  float density;  // with which it was drawn, per solid angle
};

/// f of the vertex's material in the scene's space, with its gain.
inline Rgb in_working_space(const std::optional<Mat3>& rec709_to_working, const Vertex& vertex, const Rgb& f) {
  const SurfaceMaterial& surface = *vertex.surface;
  return surface.gain * (rec709_to_working && surface.rec709_colors ? *rec709_to_working * f : f);
}

/// The ray along a direction that was drawn by the surface side with density `pdf`; `reflected`: f, times the
/// throughput so far. Nothing when it would go below the surface or carry nothing.
std::optional<Continuation> onward_along(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world,
                                         const Rgb& reflected, float pdf);

/// One ray drawn with `u` by the surface side, and `throughput` f cos / pdf, which need not be finite. Nothing when it
/// would go below the surface or carry nothing. `prepared` is the material's point.
std::optional<Continuation> draw_onward(const Vertex& vertex, const PreparedBrdf& prepared, SurfaceSampling sampling,
                                        const std::optional<Mat3>& rec709_to_working, const Rgb& throughput,
                                        const Vec2& u);

}  // namespace velour

// Continuation rays of paths.
#pragma once

#include <optional>

#include "render/direction_sampling.h"

namespace velour {

struct Continuation {
  Ray ray;
  Rgb throughput;
  Vec3 wl;        // local
  float density;  // sampling density, per solid angle
};

/// f of the vertex's material in the scene's working space, with its gain.
inline Rgb in_working_space(const std::optional<Mat3>& rec709_to_working, const Vertex& vertex, const Rgb& f) {
  const SurfaceMaterial& surface = *vertex.surface;
  return surface.gain * (rec709_to_working && surface.rec709_colors ? *rec709_to_working * f : f);
}

/// Continuation along a direction that was sampled from the surface with density `pdf`; `reflected`: f times the
/// throughput so far. Empty if it would go below the surface or carry nothing.
std::optional<Continuation> onward_along(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world,
                                         const Rgb& reflected, float pdf);

/// Continuation sampled from the surface with `u`, with throughput `throughput` f cos / pdf, which need not be finite.
/// Empty if it would go below the surface or carry nothing. `prepared`: material at the vertex.
std::optional<Continuation> draw_onward(const Vertex& vertex, const PreparedBrdf& prepared, SurfaceSampling sampling,
                                        const std::optional<Mat3>& rec709_to_working, const Rgb& throughput,
                                        const Vec2& u);

}  // namespace velour

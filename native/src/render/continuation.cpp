#include "render/continuation.h"

#include <cmath>
#include <limits>

namespace velour {

std::optional<Continuation> continuation_along(const Vertex& vertex, const Vec3& wl, const Vec3& wl_world,
                                               const Rgb& reflected, float pdf) {
  if (!vertex.receives(wl, wl_world) || reflected == Rgb(0.0f)) return std::nullopt;
  return Continuation{vertex.ray(wl_world, std::numeric_limits<float>::infinity()), reflected * (std::abs(wl.z) / pdf),
                      wl, pdf};
}

std::optional<Continuation> sample_continuation(const Vertex& vertex, const PreparedSurface& prepared,
                                                const std::optional<Mat3>& rec709_to_working, const Rgb& throughput,
                                                const Vec2& u) {
  DirectionBatch wl;
  prepared.sample({&u, 1}, wl);
  wl.pad();
  const Vec3 wl_world = vertex.frame.to_world(wl.get(0));
  if (!vertex.receives(wl.get(0), wl_world)) return std::nullopt;
  RgbBatch f;
  ScalarBatch material_pdf, pdf;
  prepared.brdf().eval(wl, f, material_pdf);
  prepared.pdf(wl, material_pdf, pdf);
  const Rgb reflected = throughput * in_working_space(rec709_to_working, vertex, f.get(0));
  return continuation_along(vertex, wl.get(0), wl_world, reflected, pdf.v[0]);
}

}  // namespace velour

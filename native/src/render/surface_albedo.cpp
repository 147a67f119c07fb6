#include "render/surface_albedo.h"

#include <cmath>

#include "render/onward.h"

namespace velour {

Rgb SurfaceAlbedo::estimate(const Vertex& vertex, PathNumbers numbers) {
  const Material& material = *vertex.surface->material;
  material.prepare(vertex.wv, vertex.site, prepared_);
  Vec2 u[kDirections];
  numbers.points(Purpose::surface, numbers.ray() * kDirections, u);
  material.sample(prepared_, u, drawn_);
  wl_.count = 0;
  for (int i = 0; i < drawn_.count; ++i) {
    const Vec3 wl = drawn_.get(i);
    if (vertex.receives(wl, vertex.frame.to_world(wl))) wl_.push(wl);
  }
  if (wl_.count == 0) return Rgb(0.0f);
  wl_.pad();
  material.eval(prepared_, wl_, f_, pdf_);
  Rgb sum(0.0f);
  for (int i = 0; i < wl_.count; ++i) {
    const Rgb term = f_.get(i) * (std::abs(wl_.z[i]) / pdf_.v[i]);
    if (std::isfinite(term.r + term.g + term.b)) sum += term;
  }
  return in_working_space(rec709_to_working_, vertex, sum / static_cast<float>(kDirections));
}

}  // namespace velour

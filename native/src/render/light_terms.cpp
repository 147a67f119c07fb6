#include "render/light_terms.h"

namespace velour {

void LightTerms::look_up(const Lighting& lighting, Heuristic heuristic) {
  const int count = world.count;
  if (count == 0) return;
  world.pad();
  ScalarBatch light_pdf;
  lighting.look_up({position, static_cast<size_t>(count)}, world, environment, light_pdf, lamp_hits);
  for (int i = 0; i < count; ++i) {
    const float q[3] = {product.v[i], surface.v[i], light_share.v[i] * light_pdf.v[i]};
    const float density = effective_density(heuristic, q, drawer[i]);
    // A direction of density 0 was drawn by rounding alone. One that is not a number passes, to be counted.
    weight.v[i] = density == 0.0f ? 0.0f : 1.0f / density;
  }
}

}  // namespace velour

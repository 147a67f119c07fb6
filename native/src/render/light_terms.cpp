#include "render/light_terms.h"

namespace velour {

float LightTerms::weighed(Heuristic heuristic, int direction, float light_pdf) const {
  const float q[3] = {product.v[direction], surface.v[direction], light_share.v[direction] * light_pdf};
  const float density = effective_density(heuristic, q, drawer[direction]);
  // A density of 0 results from rounding alone. NaN passes, to be counted.
  return density == 0.0f ? 0.0f : 1.0f / density;
}

void LightTerms::look_up(const Lighting& lighting, std::span<const LightView> views, Heuristic heuristic) {
  const int count = world.count;
  if (count == 0) return;
  world.pad();
  ScalarBatch light_pdf;
  lighting.look_up(views, {receiver, static_cast<size_t>(count)}, world, environment, light_pdf, lamp_hits);
  for (int i = 0; i < count; ++i) weight.v[i] = aim[i] != 0 ? 0.0f : weighed(heuristic, i, light_pdf.v[i]);
  for (const LampHit& hit : lamp_hits) {
    const int i = hit.direction;
    lamp_weight.v[i] = aim[i] != 0 ? 0.0f : weighed(kLampHeuristic, i, light_pdf.v[i]);
  }
}

void LightTerms::look_up_glow(const Lighting& lighting, std::span<const LightView> views, std::span<const Hit> aims,
                              std::span<const Ray> rays) {
  find_glow(lighting.glow(), aims, rays);
  for (Glow& g : glow) {
    const int i = g.direction;
    const float pdf = light_share.v[i] > 0.0f ? lighting.glow_pdf(views[receiver[i]], world.get(i), g.hit) : 0.0f;
    g.weight = weighed(kLampHeuristic, i, pdf);
  }
}

void LightTerms::find_glow(const GlowingSurfaces& surfaces, std::span<const Hit> aims, std::span<const Ray> rays) {
  Ray searching[DirectionBatch::kCapacity];
  int number[DirectionBatch::kCapacity];
  size_t count = 0;
  for (int i = 0; i < world.count; ++i) {
    if (aim[i] != 0) {
      glow.push_back({i, aims[aim[i] - size_t{1}], 0.0f});
    } else if (drawer[i] != Drawer::lights) {
      number[count] = i;
      searching[count++] = rays[static_cast<size_t>(i)];
    }
  }
  found_.clear();
  surfaces.meet({searching, count}, found_);
  for (const GlowHit& f : found_) glow.push_back({number[f.ray], f.hit, 0.0f});
}

}  // namespace velour

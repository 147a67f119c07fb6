// Samplers of materials that fill PreparedBrdf::warped, and the cells that resolve them.
#pragma once

#include <algorithm>

#include "math/srbf/warped_lobe.h"
#include "support/proof_materials.h"

namespace velour::test {

/// Cells about the sharpest lobe that is there at the view and the site. Draws whose half vector faces away from
/// the viewer have no direction; they are a cell of their own.
inline Sampler warped_sampler(const std::shared_ptr<const Material>& material, const Vec3& wv,
                              const SurfaceSite& site = SurfaceSite::everywhere()) {
  const auto point = std::make_unique<PreparedBrdf>();
  material->prepare(wv, site, *point);
  const WarpedMixture& m = point->warped;
  const auto sharpest = std::max_element(m.bandwidth, m.bandwidth + m.count) - m.bandwidth;
  const bool half = m.half[sharpest] > 0;
  const WarpedLobe lobe{half ? LobeSpace::half : LobeSpace::light,
                        {m.s_xx[sharpest], m.s_xy[sharpest], m.s_yy[sharpest]},
                        Vec3d(m.x[sharpest], m.y[sharpest], m.z[sharpest])};
  const auto axis = unwarped(lobe, lobe.center, Vec3d(m.wv));
  Sampler sampler = material_sampler(material, wv, site);
  sampler.may_fail = true;
  sampler.sample = [draw = sampler.sample](const Vec2& u) {
    const Vec3 wl = draw(u);
    return wl == Vec3(0, 0, -1) ? Vec3(0) : wl;
  };
  if (!axis || m.bandwidth[sharpest] < 10) return sampler;
  const Vec3 turned(m.turn_cos * axis->x - m.turn_sin * axis->y, m.turn_sin * axis->x + m.turn_cos * axis->y, axis->z);
  const float across = half ? 2 * std::max(wv.z, 0.01f) : 1;
  sampler.axis = turned;
  // Against the view, where half vectors are normal to it, the density grows without bound.
  if (half) sampler.refinements = {2, 9};
  sampler.concentration = m.bandwidth[sharpest] / (across * across);
  return sampler;
}

}  // namespace velour::test

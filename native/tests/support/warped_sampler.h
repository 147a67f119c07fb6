// Samplers of materials, and the cells that resolve their lobes.
#pragma once

#include <algorithm>

#include "brdf/eval/parametric_material.h"
#include "brdf/eval/parametric_table.h"
#include "math/srbf/warped_lobe.h"
#include "math/srbf/warped_mixture.h"
#include "support/proof_materials.h"

namespace velour::test {

/// The material's sampler. Samples whose half vector faces away from the viewer have no direction; they are a cell of
/// their own.
inline Sampler sampler_that_may_fail(const std::shared_ptr<const Material>& material, const Vec3& wv,
                                     const SurfaceSite& site) {
  Sampler sampler = material_sampler(material, wv, site);
  sampler.may_fail = true;
  sampler.sample = [draw = sampler.sample](const Vec2& u) {
    const Vec3 wl = draw(u);
    return wl == Vec3(0, 0, -1) ? Vec3(0) : wl;
  };
  return sampler;
}

// Against the view, where half vectors are normal to it, the density of half-vector lobes grows without bound.
inline const CellRefinements kHalfRefinements = {2, 9};

/// The sampler of a parametric model, with cells about its sharpest lobe at the view.
inline Sampler warped_sampler(const std::shared_ptr<const ParametricBrdf>& brdf, const Vec3& wv) {
  WarpedMixture m;
  ParametricValues(*brdf).evaluate(wv, ViewPlace(wv), m);
  const auto sharpest = std::max_element(m.bandwidth, m.bandwidth + m.count) - m.bandwidth;
  const bool half = m.half[sharpest] > 0;
  const WarpedLobe lobe{half ? LobeSpace::half : LobeSpace::light,
                        {m.s_xx[sharpest], m.s_xy[sharpest], m.s_yy[sharpest]},
                        Vec3d(m.x[sharpest], m.y[sharpest], m.z[sharpest])};
  const auto axis = unwarped(lobe, lobe.center, Vec3d(m.wv));
  Sampler sampler = sampler_that_may_fail(make_parametric_material(brdf), wv, SurfaceSite::everywhere());
  if (!axis || m.bandwidth[sharpest] < 10) return sampler;
  const Vec3 turned(m.turn_cos * axis->x - m.turn_sin * axis->y, m.turn_sin * axis->x + m.turn_cos * axis->y, axis->z);
  const float across = half ? 2 * std::max(wv.z, 0.01f) : 1;
  sampler.axis = turned;
  if (half) sampler.refinements = kHalfRefinements;
  sampler.concentration = m.bandwidth[sharpest] / (across * across);
  return sampler;
}

/// Cells about the highlight of a BTF at a view and a site, which its proposal lobes show.
inline Sampler highlight_sampler(const std::shared_ptr<const Material>& material, const Vec3& wv,
                                 const SurfaceSite& site) {
  Sampler sampler = sampler_that_may_fail(material, wv, site);
  ScratchArena arena;
  ProposalLobes lobes;
  if (!material->prepare(wv, site, {}, arena)->proposal_lobes(lobes)) return sampler;
  const auto* const sharpest =
      std::ranges::max_element(lobes.lobe, lobes.lobe + lobes.count, {}, &GaussianLobe::bandwidth);
  if (sharpest->bandwidth < 10) return sampler;
  sampler.axis = sharpest->center;
  sampler.refinements = kHalfRefinements;
  sampler.concentration = sharpest->bandwidth;
  return sampler;
}

}  // namespace velour::test

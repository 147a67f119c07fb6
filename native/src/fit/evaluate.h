// Evaluates a material at any number of light directions; lists the views at which errors are reported.
#pragma once

#include <span>
#include <vector>

#include "material/material.h"

namespace velour {

/// f (1/sr, no cosine) of `material` and the density (1/sr) of its sampler, for one view and each of `wl`. Either
/// output may be empty and is then skipped.
void evaluate(const Material& material, const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f,
              std::span<float> density = {});

/// Views that represent one reported polar angle (degrees): one on the meridian if isotropic, otherwise eight azimuths.
std::vector<Vec3> reported_views(int degrees, bool isotropic);

/// The reported view (degrees) that an irregular sample at `wv` counts for: the nearest within kHeldOutGroup, or -1.
int reported_view_of(const Vec3& wv);

}  // namespace velour

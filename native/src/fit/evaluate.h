// A material at any number of light directions, and the views at which errors are reported.
#pragma once

#include <span>
#include <vector>

#include "material/material.h"

namespace velour {

/// f (1/sr, no cosine) of `material` and the density (1/sr) of its sampler, for one view and each of `wl`. Either
/// result may be empty: then it is left out.
void evaluate(const Material& material, const Vec3& wv, std::span<const Vec3> wl, std::span<Rgb> f,
              std::span<float> density = {});

/// The views that stand for one reported polar angle: one on the meridian for isotropic data, eight azimuths else.
std::vector<Vec3> reported_views(int degrees, bool isotropic);

/// The reported view that a scattered sample at `wv` counts for: the nearest within kHeldOutGroup; -1 when there is
/// none.
int reported_view_of(const Vec3& wv);

}  // namespace velour

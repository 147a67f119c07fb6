// The density that follows f cos at a view: the lobes of f, moved and sharpened to what is left of them.
#pragma once

#include "material/light_points.h"

namespace velour {

struct DrawFit {
  double mass;    // integral of the luminance of f cos over the hemisphere
  double cosine;  // probability of the clipped cosine about the normal; with those of the lobes 1, where there is mass
  std::vector<DrawnLobe> lobes;
};

/// Expectation maximisation of the likelihood [BDGS05] on a quadrature: evenly spread draws of every lobe and of the
/// cosine, weighted by f cos over their joint density, and drawn anew from the fit so far. So a lobe that the horizon
/// cuts gets its centre above it, what lobes share is shared, and nearly constant ones give way to the cosine. Good to
/// a few per cent, which costs draws nothing.
DrawFit fit_draws(std::span<const WarpedLobe> lobes, const Vec3d& wv);

}  // namespace velour

// A Glossy BSDF of Cycles with a tilted normal, and its derivatives, at all lights of a view. Formulas are those of
// kernel/closure/bsdf_microfacet.h.
#pragma once

#include <cstddef>
#include "brdf/fit/closures/closure_lights.h"

namespace velour {

enum class LobeDistribution { ggx, beckmann };

/// Masking and shadowing of microfacets by Smith's function.
enum class LobeMasking {
  separable,          // G1(wv) G1(wl): Blender before 3.5
  height_correlated,  // 1 / (1 + Lambda(wv) + Lambda(wl)): later versions
};

/// A lobe at a view in the x-z plane.
struct ClosureLobeShape {
  LobeDistribution distribution = LobeDistribution::ggx;
  LobeMasking masking = LobeMasking::separable;
  float alpha_x = 1, alpha_y = 1;  // along and across the plane of incidence
  float tilt = 0;                  // radians; N' = (sin(tilt), 0, cos(tilt)); the viewer is in front of N'
};

// Arrays of floats are aligned to cache lines (AlignedArray).

/// D G / (4 wv.N') (1/sr, without the cosine of the light) times root_weight, for each light; 0 behind N'.
void fill_lobe(const ClosureLights& lights, const ClosureLobeShape& shape, float* value);

/// Factors of the derivatives by log(alpha_x), log(alpha_y) and the tilt in those by three other parameters.
struct LobeChain {
  float alpha_x, alpha_y;      // parameter 0
  float tilt;                  // parameter 1
  float stretch_x, stretch_y;  // parameter 2
};

/// fill_lobe(), and its derivatives by the three parameters of `chain`. Rows of `out` are padded() apart.
void fill_lobe_slopes(const ClosureLights& lights, const ClosureLobeShape& shape, const LobeChain& chain, float* out);

/// Dot products of `rows` rows of `count` floats each, a multiple of 16: `gram` gets those of each pair (row-major,
/// only j <= i is set), `moments` those with each of the four arrays of `fixed`.
void fill_products(const float* data, int rows, size_t count, const float* const fixed[4], float* gram,
                   float (*moments)[4]);

}  // namespace velour

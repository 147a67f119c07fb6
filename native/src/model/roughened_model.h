// Artistic roughness: BRDF models with widened lobes.
#pragma once

#include "model/model.h"

namespace velour {

/// The model of a surface that is rougher by `roughness` in [0, 1]; 0 gives the same model. Every lobe is convolved
/// with the lobe that this roughness spreads a mirror to (math/srbf/kernel.h), and keeps the light that it
/// reflects at every view, so the albedo is preserved. Cosine terms are unchanged. The result is an ordinary model with
/// its own densities; its record is the original's plus a warning. Throws Error(invalid_argument) for a BTF and for
/// other numbers. Negative ones are refused because a highlight is a sum of lobes, which would come apart if narrowed.
Model roughened(const Model& model, float roughness);

/// Roughness of a GGX highlight about as narrow as the narrowest lobe that reflects a noticeable share of the light at
/// some view, in [0, 1]: the inverse of half_bandwidth_of_roughness(). 1 without lobes.
double narrowest_roughness(const PerViewBrdf& brdf);
double narrowest_roughness(const ParametricBrdf& brdf);

/// Roughened bodies of models. Requires 0 < roughness <= 1.
PerViewBrdf roughened(const PerViewBrdf& brdf, double roughness);
ParametricBrdf roughened(const ParametricBrdf& brdf, double roughness);

}  // namespace velour

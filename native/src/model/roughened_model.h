// An artist's roughness: models of BRDFs with wider lobes.
#pragma once

#include "model/model.h"

namespace velour {

/// The model of a surface that is rougher by `roughness`, in [0, 1]: every lobe is convolved with what that spreads a
/// mirror to (srbf/widened_lobe.h), and keeps the light that it reflects at every view, so the albedo stays. Cosine
/// terms stay. It is a model like any other, with densities of its own; 0 gives the same one. Its record is the
/// original's, with a sentence that says so.
/// Throws Error(invalid_argument) for a BTF, and for other numbers: negative ones too, since a highlight is a sum of
/// lobes, and narrower ones would come apart.
Model roughened(const Model& model, float roughness);

/// The parts of it. 0 < roughness <= 1.
ScatteredBrdf roughened(const ScatteredBrdf& brdf, double roughness);
ParametricBrdf roughened(const ParametricBrdf& brdf, double roughness);

}  // namespace velour

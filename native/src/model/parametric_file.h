// The parametric model's parts and attributes in the model file (docs/reference/model_file.md, "Model file").
#pragma once

#include "brdf/model/parametric_brdf.h"
#include "model/model_fields.h"

namespace velour {

/// Throws Error(invalid_argument) for control values that a half float cannot hold.
void write_parametric(const ParametricBrdf& brdf, TensorFile& file);
/// Checks every shape and range.
ParametricBrdf read_parametric(const ModelFields& fields);

}  // namespace velour

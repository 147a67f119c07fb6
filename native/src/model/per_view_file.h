// The per-view model's parts and attributes in the model file (docs/reference/model_file.md, "Model file").
#pragma once

#include "brdf/model/per_view_brdf.h"
#include "model/model_fields.h"

namespace velour {

void write_per_view(const PerViewBrdf& brdf, TensorFile& file);
/// Checks every shape and range.
PerViewBrdf read_per_view(const ModelFields& fields);

}  // namespace velour

// A factored BTF's parts and attributes in the model file (docs/reference/model_file.md, "Model file").
#pragma once

#include "btf/model/factored_btf.h"
#include "model/model_fields.h"

namespace velour {

void write_factored(const FactoredBtf& btf, TensorFile& file);
/// Checks every shape and range.
FactoredBtf read_factored(const ModelFields& fields);

}  // namespace velour

// Clustered tensors of BTFs as named parts of model files: docs/reference/model_file.md.
#pragma once

#include "btf/model/tensor_btf.h"
#include "model/model_fields.h"

namespace velour {

void write_tensor_btf(const TensorBtf& btf, TensorFile& file);
/// Checks every shape and range; the result can be evaluated without further checks.
TensorBtf read_tensor_btf(const ModelFields& fields);

}  // namespace velour

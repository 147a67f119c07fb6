// A BTF of multivariate SRBFs as parts and attributes of the model file (docs/reference/model_file.md, "Model file").
#pragma once

#include "btf/model/srbf_btf.h"
#include "model/model_fields.h"

namespace velour {

void write_srbf_btf(const SrbfBtf& btf, TensorFile& file);
/// Checks every shape and range.
SrbfBtf read_srbf_btf(const ModelFields& fields);

}  // namespace velour

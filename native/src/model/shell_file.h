// The shell of a model in its file.
#pragma once

#include "model/model.h"
#include "model/model_fields.h"

namespace velour {

void write_shell(const ModelShell& shell, TensorFile& file);
/// None where the file has none.
std::optional<ModelShell> read_shell(const ModelFields& fields);

}  // namespace velour

// The silhouette shell (VOTF) of a model in its file.
#pragma once

#include "model/model.h"
#include "model/model_fields.h"

namespace velour {

void write_shell(const ModelShell& shell, TensorFile& file);
/// Nothing if the file has no shell.
std::optional<ModelShell> read_shell(const ModelFields& fields);

}  // namespace velour

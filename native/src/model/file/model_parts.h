// Each kind of model as parts and attributes of the model file (docs/reference/model_file.md, "Model file").
#pragma once

#include "brdf/model/parametric_brdf.h"
#include "brdf/model/per_view_brdf.h"
#include "btf/model/factored_btf.h"
#include "btf/model/srbf_btf.h"
#include "btf/model/tensor_btf.h"
#include "model/file/model_fields.h"
#include "model/model.h"

namespace velour {

/// Throws Error(invalid_argument) for control values that a half float cannot hold.
void write_parametric(const ParametricBrdf& brdf, TensorFile& file);
/// Checks every shape and range.
ParametricBrdf read_parametric(const ModelFields& fields);

void write_per_view(const PerViewBrdf& brdf, TensorFile& file);
/// Checks every shape and range.
PerViewBrdf read_per_view(const ModelFields& fields);

void write_factored(const FactoredBtf& btf, TensorFile& file);
/// Checks every shape and range.
FactoredBtf read_factored(const ModelFields& fields);

void write_srbf_btf(const SrbfBtf& btf, TensorFile& file);
/// Checks every shape and range.
SrbfBtf read_srbf_btf(const ModelFields& fields);

void write_tensor_btf(const TensorBtf& btf, TensorFile& file);
/// Checks every shape and range; the result can be evaluated without further checks.
TensorBtf read_tensor_btf(const ModelFields& fields);

// The silhouette shell (VOTF) of a model in its file.

void write_shell(const ModelShell& shell, TensorFile& file);
/// Nothing if the file has no shell.
std::optional<ModelShell> read_shell(const ModelFields& fields);

}  // namespace velour

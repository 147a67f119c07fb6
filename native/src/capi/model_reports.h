// JSON texts about models: the keys of the command line's verbs (docs/command_line.md).
#pragma once

#include <string>
#include <vector>

#include "capi/json_text.h"
#include "model/model.h"

namespace velour::capi {

/// How many lobes or components a model has, and its bytes.
Json size_json(const Model& model, uint64_t file_bytes);

std::string model_json(const Model& model, uint64_t file_bytes);
/// Of an outline that took `seconds`.
std::string votf_json(const ModelShell& shell, double seconds, const std::vector<std::string>& warnings);

}  // namespace velour::capi

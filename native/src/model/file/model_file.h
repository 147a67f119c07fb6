// The model file: named tensors in an OpenEXR file, docs/reference/model_file.md.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "model/model.h"

namespace velour {

std::vector<uint8_t> encode_model(const Model& model);
/// Checks every shape and range, and names the field at fault. `name`: the file's name, for messages.
Model decode_model(std::span<const uint8_t> bytes, const std::string& name);

void save_model(const Model& model, const std::string& path);
Model load_model(const std::string& path);
/// True for a model file (an OpenEXR file with Velour's kind attribute).
bool is_model_file(const std::string& path);

}  // namespace velour

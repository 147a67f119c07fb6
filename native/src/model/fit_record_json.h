// The fit record as the text of one attribute of the model file.
#pragma once

#include <string>

#include "model/model.h"

namespace velour {

/// JSON; numbers keep all their digits.
std::string fit_record_json(const FitRecord& record);

/// Throws Error(bad_data) with `where` (file and attribute) and the key at fault. Missing keys keep their defaults,
/// unknown ones are ignored.
FitRecord parse_fit_record(const std::string& text, const std::string& where);

}  // namespace velour

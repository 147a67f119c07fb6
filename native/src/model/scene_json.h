// The scene record of a scene model as the text of one attribute of its file.
#pragma once

#include <string>

#include "model/records.h"

namespace velour {

/// JSON. Weights keep four digits.
std::string scene_record_json(const SceneRecord& record);

/// Throws Error(bad_data) with `where` (file and attribute) and the key at fault.
SceneRecord parse_scene_record(const std::string& text, const std::string& where);

}  // namespace velour

// The records of a fit and of a scene model as texts of attributes of the model file.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include "model/model.h"
#include "model/records.h"

namespace velour {

// The fit record as the text of one attribute of the model file.

/// JSON; numbers keep all their digits.
std::string fit_record_json(const FitRecord& record);

/// Throws Error(bad_data) with `where` (file and attribute) and the key at fault. Missing keys keep their defaults,
/// unknown ones are ignored.
FitRecord parse_fit_record(const std::string& text, const std::string& where);

// The order curve as JSON: one list per column, as for plots.

/// {"lobes": [], "parameter_bytes": [], "worst": [], "relative_l2": [], "chosen": index or null}. Errors keep four
/// digits, so that model files stay small and reading and writing one again does not change it.
nlohmann::ordered_json order_json(const OrderCurve& order);

/// Throws Error(bad_data) with `where` (file and field) and the key at fault.
OrderCurve parse_order(const nlohmann::ordered_json& json, const std::string& where);

// The scene record of a scene model as the text of one attribute of its file.

/// JSON. Weights keep four digits.
std::string scene_record_json(const SceneRecord& record);

/// Throws Error(bad_data) with `where` (file and attribute) and the key at fault.
SceneRecord parse_scene_record(const std::string& text, const std::string& where);

}  // namespace velour

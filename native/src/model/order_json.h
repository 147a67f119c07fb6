// The order curve as JSON: one list a column, as plots take it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "model/order_curve.h"

namespace velour {

/// `value` with four digits.
double four_digits(double value);

/// {"lobes": [], "parameter_bytes": [], "worst": [], "relative_l2": [], "chosen": index or null}. Errors keep four
/// digits: a model file stays small, and what is read and written again stays the same.
nlohmann::ordered_json order_json(const OrderCurve& order);

/// Throws Error(bad_data) with `where` (file and field) and the key at fault.
OrderCurve parse_order(const nlohmann::ordered_json& json, const std::string& where);

}  // namespace velour

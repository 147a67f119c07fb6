// The order curve as JSON: one list per column, as for plots.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "model/order_curve.h"

namespace velour {

/// `value` rounded to four significant digits.
double four_digits(double value);

/// {"lobes": [], "parameter_bytes": [], "worst": [], "relative_l2": [], "chosen": index or null}. Errors keep four
/// digits, so that model files stay small and reading and writing one again does not change it.
nlohmann::ordered_json order_json(const OrderCurve& order);

/// Throws Error(bad_data) with `where` (file and field) and the key at fault.
OrderCurve parse_order(const nlohmann::ordered_json& json, const std::string& where);

}  // namespace velour

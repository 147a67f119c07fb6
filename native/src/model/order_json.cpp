#include "model/order_json.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "job/error.h"

namespace velour {
namespace {

using Json = nlohmann::ordered_json;

constexpr size_t kMaxPoints = 1000;
constexpr double kMaxWhole = 1e15;  // exact as a double

std::vector<double> column(const Json& json, const char* key, double most, const std::string& where) {
  const auto found = json.find(key);
  const auto fail = [&](const std::string& wanted) {
    throw Error(Status::bad_data, where + ": '" + key + "' must be " + wanted + "; the model file is damaged.");
  };
  if (found == json.end() || !found->is_array() || found->size() > kMaxPoints) fail("a list of at most 1000 numbers");
  std::vector<double> out;
  for (const Json& entry : *found) {
    const double value = entry.is_number() ? entry.get<double>() : -1;
    if (!(value >= 0 && value <= most)) fail("a list of numbers from 0 to " + std::to_string(most));
    out.push_back(value);
  }
  return out;
}

}  // namespace

double four_digits(double value) {
  std::array<char, 32> text;
  const auto written = std::to_chars(text.begin(), text.end(), value, std::chars_format::scientific, 3);
  double rounded = value;
  std::from_chars(text.begin(), written.ptr, rounded);
  return rounded;
}

Json order_json(const OrderCurve& order) {
  Json json = {{"lobes", Json::array()},
               {"parameter_bytes", Json::array()},
               {"worst", Json::array()},
               {"relative_l2", Json::array()},
               {"chosen", order.chosen ? Json(*order.chosen) : Json(nullptr)}};
  for (const OrderPoint& p : order.points) {
    json["lobes"].push_back(p.lobes);
    json["parameter_bytes"].push_back(p.parameter_bytes);
    json["worst"].push_back(four_digits(p.worst));
    json["relative_l2"].push_back(four_digits(p.relative_l2));
  }
  return json;
}

OrderCurve parse_order(const Json& json, const std::string& where) {
  if (!json.is_object()) throw Error(Status::bad_data, where + " is not an object; the model file is damaged.");
  const auto lobes = column(json, "lobes", std::numeric_limits<int>::max(), where);
  const auto bytes = column(json, "parameter_bytes", kMaxWhole, where);
  const auto worst = column(json, "worst", std::numeric_limits<double>::max(), where);
  const auto relative_l2 = column(json, "relative_l2", std::numeric_limits<double>::max(), where);
  if (bytes.size() != lobes.size() || worst.size() != lobes.size() || relative_l2.size() != lobes.size()) {
    throw Error(Status::bad_data, where + ": its lists differ in length; the model file is damaged.");
  }
  OrderCurve order;
  for (size_t i = 0; i < lobes.size(); ++i) {
    order.points.push_back({static_cast<int>(lobes[i]), static_cast<uint64_t>(bytes[i]), worst[i], relative_l2[i]});
  }
  const auto chosen = json.find("chosen");
  if (chosen == json.end() || chosen->is_null()) return order;
  if (!chosen->is_number_unsigned() || chosen->get<uint64_t>() >= lobes.size()) {
    throw Error(Status::bad_data, where + ": 'chosen' must be the index of a point; the model file is damaged.");
  }
  order.chosen = chosen->get<size_t>();
  return order;
}

}  // namespace velour

#include "base/warning.h"

#include <algorithm>
#include <cmath>
#include "base/json_fields.h"

namespace velour {

namespace {

using Json = JsonFields::Json;

constexpr size_t kMaxWarnings = 1000, kMaxListed = 1000;

Json value_json(const WarningValue& value) {
  return std::visit(
      []<typename T>(const T& v) -> Json {
        if constexpr (std::is_same_v<T, double>) {
          return four_digits(v);
        } else if constexpr (std::is_same_v<T, std::vector<double>>) {
          Json list = Json::array();
          for (const double number : v) list.push_back(four_digits(number));
          return list;
        } else {
          return v;
        }
      },
      value);
}

Json warning_json(const Warning& warning) {
  Json values = Json::object();
  for (const auto& [name, value] : warning.values) values[name] = value_json(value);
  return {{"code", kind_of(warning.code).key}, {"values", std::move(values)}};
}

/// Reads the warnings of one record.
class WarningReader {
 public:
  WarningReader(const Json& record, const JsonSource& source) : record_(record), fields_(record, source) {}

  std::vector<Warning> read() const {
    std::vector<Warning> warnings;
    for (const Json& sentence : list("warnings", "a list of sentences")) {
      if (!sentence.is_string()) fields_.fail("warnings", "a list of sentences");
      warnings.push_back(warning<WarningCode::stored_sentence>({{"text", sentence.get<std::string>()}}));
    }
    for (const Json& entry : list(kCodes, kWanted)) warnings.push_back(parse(entry));
    return warnings;
  }

 private:
  static constexpr const char *kCodes = "warning_codes", *kWanted = "a list of codes, each with its values";

  Json list(const char* key, const char* wanted) const {
    if (!fields_.has(key)) return Json::array();
    const Json& json = record_.at(key);
    if (!json.is_array() || json.size() > kMaxWarnings) fields_.fail(key, wanted);
    return json;
  }
  [[noreturn]] void fail() const { fields_.fail(kCodes, kWanted); }

  Warning parse(const Json& entry) const {
    if (!entry.is_object() || !entry.contains("code") || !entry.contains("values")) fail();
    const Json &code = entry.at("code"), &values = entry.at("values");
    if (!code.is_string() || !values.is_object()) fail();
    const auto key = code.get<std::string>();
    const auto kind = std::ranges::find(kWarningKinds, key, &WarningKind::key);
    if (kind == kWarningKinds.end()) return warning<WarningCode::unknown_warning>({{"code", key}});
    if (values.size() != kind->count()) fail();
    Warning warning{static_cast<WarningCode>(kind - kWarningKinds.begin()), {}};
    for (const auto& [name, value] : values.items()) {
      if (!kind->has(name)) fail();
      warning.values.emplace_back(name, parse_value(value));
    }
    return warning;
  }

  WarningValue parse_value(const Json& json) const {
    if (json.is_number_unsigned()) return json.get<uint64_t>();
    if (json.is_number()) return finite(json);
    if (json.is_string()) return json.get<std::string>();
    if (!json.is_array() || json.size() > kMaxListed) fail();
    if (std::ranges::all_of(json, [](const Json& v) { return v.is_number(); })) {
      std::vector<double> numbers;
      for (const Json& number : json) numbers.push_back(finite(number));
      return numbers;
    }
    if (!std::ranges::all_of(json, [](const Json& v) { return v.is_string(); })) fail();
    return json.get<std::vector<std::string>>();
  }

  double finite(const Json& number) const {
    const auto value = number.get<double>();
    if (!std::isfinite(value)) fail();
    return value;
  }

  const Json& record_;
  const JsonFields fields_;
};

}  // namespace

nlohmann::ordered_json warnings_json(const std::vector<Warning>& warnings) {
  Json json = Json::array();
  for (const Warning& warning : warnings) json.push_back(warning_json(warning));
  return json;
}

void put_warnings(const std::vector<Warning>& warnings, nlohmann::ordered_json& record) {
  Json sentences = Json::array(), codes = Json::array();
  for (const Warning& warning : warnings) {
    if (warning.code == WarningCode::stored_sentence) {
      sentences.push_back(value_json(warning.values[0].second));
    } else {
      codes.push_back(warning_json(warning));
    }
  }
  record["warnings"] = std::move(sentences);
  record["warning_codes"] = std::move(codes);
}

std::vector<Warning> parse_warnings(const nlohmann::ordered_json& record, const std::string& where) {
  const JsonSource source{where, "the model file is damaged. Copy it again, or fit the model again."};
  return WarningReader(record, source).read();
}

}  // namespace velour

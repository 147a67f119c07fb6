#include "base/json_fields.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include "base/error.h"

namespace velour {

JsonFields::JsonFields(const Json& json, const JsonSource& source, std::string path)
    : json_(json), source_(source), path_(std::move(path)) {}

void JsonFields::fail(const std::string& key, const std::string& wanted) const {
  throw Error(Status::bad_data, source_.name + ": '" + path_ + key + "' must be " + wanted + "; " + source_.remedy);
}

const JsonFields::Json& JsonFields::at(const char* key) const {
  const auto found = json_.find(key);
  if (found == json_.end()) fail(key, "present");
  return *found;
}

JsonFields JsonFields::object(const char* key) const {
  const Json& json = at(key);
  if (!json.is_object()) fail(key, "an object");
  return {json, source_, path_ + key + "."};
}

std::string JsonFields::text(const char* key) const {
  const Json& json = at(key);
  if (!json.is_string()) fail(key, "a string");
  return json.get<std::string>();
}

bool JsonFields::flag(const char* key) const {
  const Json& json = at(key);
  if (!json.is_boolean()) fail(key, "true or false");
  return json.get<bool>();
}

uint64_t JsonFields::whole(const char* key, uint64_t most) const {
  const Json& json = at(key);
  if (!json.is_number_unsigned() || json.get<uint64_t>() > most) {
    fail(key, "an integer from 0 to " + std::to_string(most));
  }
  return json.get<uint64_t>();
}

double JsonFields::number_of(const Json& json, const char* key) const {
  const double value = json.is_number() ? json.get<double>() : -1.0;
  if (!(value >= 0.0) || !std::isfinite(value)) fail(key, "a finite number of at least 0");
  return value;
}

double JsonFields::number(const char* key) const { return number_of(at(key), key); }

double JsonFields::number_or_infinite(const char* key) const {
  return at(key).is_null() ? std::numeric_limits<double>::infinity() : number(key);
}

std::vector<double> JsonFields::numbers(const char* key, size_t count) const {
  const Json& json = at(key);
  if (!json.is_array() || json.size() != count) fail(key, "a list of " + std::to_string(count) + " numbers");
  std::vector<double> out;
  for (const Json& entry : json) out.push_back(number_of(entry, key));
  return out;
}

std::vector<uint8_t> JsonFields::bytes(const char* key, uint64_t count) const {
  const Json& json = at(key);
  if (!json.is_string()) fail(key, "base64 of " + std::to_string(count) + " bytes");
  auto bytes = parse_base64(json.get_ref<const std::string&>());
  if (!bytes || bytes->size() != count) fail(key, "base64 of " + std::to_string(count) + " bytes");
  return std::move(*bytes);
}

double four_digits(double value) {
  std::array<char, 32> text;
  const auto written = std::to_chars(text.begin(), text.end(), value, std::chars_format::scientific, 3);
  double rounded = value;
  std::from_chars(text.begin(), written.ptr, rounded);
  return rounded;
}

namespace {

/// Whether no value of the JSON `text` is nested too deep and no object has too many members. This is not left to a
/// callback of the parser, with which arrays of arrays take quadratic time, as objects of many members always do.
bool is_modest(std::span<const uint8_t> text) {
  constexpr size_t kMaxDepth = 32, kMaxMembers = 1024;
  std::array<size_t, kMaxDepth + 1> members{};  // [depth]
  size_t depth = 0;
  bool is_quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const uint8_t c = text[i];
    if (is_quoted) {
      if (c == '\\') ++i;
      is_quoted = c != '"';
      continue;
    }
    is_quoted = c == '"';
    if (c == '{' || c == '[') {
      if (++depth > kMaxDepth) return false;
      members[depth] = 0;
    }
    if ((c == '}' || c == ']') && depth > 0) --depth;
    if (c == ':' && ++members[depth] > kMaxMembers) return false;
  }
  return true;
}

}  // namespace

JsonFields::Json parse_json(std::span<const uint8_t> text) {
  using Json = JsonFields::Json;
  if (!is_modest(text)) return Json(Json::value_t::discarded);
  return Json::parse(text.begin(), text.end(), nullptr, false);
}

JsonFields::Json parse_json(const std::string& text) {
  return parse_json({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

bool is_of_format(const JsonFields::Json& json, const char* format) {
  if (!json.is_object()) return false;
  const auto found = json.find("format");
  return found != json.end() && *found == format;
}

namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr uint8_t kNoDigit = 64;

constexpr std::array<uint8_t, 256> kValues = [] {
  std::array<uint8_t, 256> values{};
  values.fill(kNoDigit);
  for (size_t i = 0; i < kDigits.size(); ++i) values[static_cast<uint8_t>(kDigits[i])] = static_cast<uint8_t>(i);
  return values;
}();

/// Appends up to three bytes as four characters.
void append_group(std::string& text, std::span<const uint8_t> bytes) {
  uint32_t bits = 0;
  for (size_t i = 0; i < 3; ++i) bits = bits << 8 | (i < bytes.size() ? bytes[i] : 0u);
  for (size_t i = 0; i < 4; ++i) text += i <= bytes.size() ? kDigits[bits >> (18 - 6 * i) & 63] : '=';
}

/// Decodes four characters, the first `digits` of which are not padding. Returns false if they are invalid.
bool append_bytes(std::vector<uint8_t>& bytes, std::string_view group, size_t digits) {
  uint32_t bits = 0;
  for (size_t i = 0; i < 4; ++i) {
    const uint8_t value = i < digits ? kValues[static_cast<uint8_t>(group[i])] : uint8_t{0};
    if (value == kNoDigit) return false;
    bits = bits << 6 | value;
  }
  for (size_t i = 0; i + 1 < digits; ++i) bytes.push_back(static_cast<uint8_t>(bits >> (16 - 8 * i)));
  const uint32_t spare = digits == 4 ? 0u : bits & ((1u << (8 * (4 - digits))) - 1u);
  return spare == 0;
}

}  // namespace

std::string base64(std::span<const uint8_t> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    append_group(text, bytes.subspan(i, std::min<size_t>(3, bytes.size() - i)));
  }
  return text;
}

std::optional<std::vector<uint8_t>> parse_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::vector<uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (size_t i = 0; i < text.size(); i += 4) {
    const std::string_view group = text.substr(i, 4);
    const bool last = i + 4 == text.size();
    const size_t digits = !last || group[3] != '=' ? 4 : group[2] != '=' ? 3 : 2;
    if (!append_bytes(bytes, group, digits)) return std::nullopt;
  }
  return bytes;
}

}  // namespace velour

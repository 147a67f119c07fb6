// Reads and checks the fields of a JSON file.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace velour {

/// Parts of error messages: the source of the fields, and the remedy ("the file is damaged; write it again.").
struct JsonSource {
  std::string name;  // of the file
  std::string remedy;
};

/// Reads the members of one JSON object. Throws Error(bad_data) with file and field for missing or invalid members.
class JsonFields {
 public:
  using Json = nlohmann::ordered_json;

  /// `path`: prefix of the object's fields in messages, "" or "hits.". `json` and `source` must outlive this object.
  JsonFields(const Json& json, const JsonSource& source, std::string path = {});

  const Json& at(const char* key) const;
  bool has(const char* key) const { return json_.contains(key); }
  JsonFields object(const char* key) const;
  std::string text(const char* key) const;
  bool flag(const char* key) const;
  uint64_t whole(const char* key, uint64_t most) const;
  /// A finite number of at least 0.
  double number(const char* key) const;
  /// Like number(), but null is infinity.
  double number_or_infinite(const char* key) const;
  /// Exactly `count` finite numbers of at least 0.
  std::vector<double> numbers(const char* key, size_t count) const;
  /// Exactly `count` little-endian values of T, stored as base64.
  template <typename T>
  std::vector<T> values(const char* key, uint64_t count) const {
    const std::vector<uint8_t> bytes = this->bytes(key, count * sizeof(T));
    std::vector<T> out(static_cast<size_t>(count));
    if (!bytes.empty()) std::memcpy(out.data(), bytes.data(), bytes.size());
    return out;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& wanted) const;

 private:
  double number_of(const Json& json, const char* key) const;
  std::vector<uint8_t> bytes(const char* key, uint64_t count) const;

  const Json& json_;
  const JsonSource& source_;
  std::string path_;
};

/// Parses any JSON file. The result is discarded (is_discarded()) if `text` is not JSON, is nested more than 32 levels
/// deep or has an object of more than 1024 members: nlohmann copies and writes nested values recursively and searches
/// members linearly, so a file must not choose these numbers.
JsonFields::Json parse_json(std::span<const uint8_t> text);
JsonFields::Json parse_json(const std::string& text);

/// Whether `json` is an object whose "format" is `format`.
bool is_of_format(const JsonFields::Json& json, const char* format);

/// `value` rounded to four significant digits.
double four_digits(double value);

// Base64 [RFC 4648, section 4], for binary arrays in JSON.

std::string base64(std::span<const uint8_t> bytes);

/// Empty unless `text` is an exact result of base64(): no blanks or line breaks, padded, spare bits zero.
std::optional<std::vector<uint8_t>> parse_base64(std::string_view text);

}  // namespace velour

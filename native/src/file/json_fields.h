// Fields of a JSON file, each checked as it is read.
#pragma once

#include <cstring>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace velour {

/// Where fields come from and what to do about a bad one: "the file is damaged, observe the scene anew."
struct JsonSource {
  std::string name;  // the file's
  std::string remedy;
};

/// Reads the members of one JSON object. What is not as it should be throws Error(bad_data) with file and field.
class JsonFields {
 public:
  using Json = nlohmann::ordered_json;

  /// `path`: the object's place within the file, "" or "hits.". Both arguments must outlive this.
  JsonFields(const Json& json, const JsonSource& source, std::string path = {});

  const Json& at(const char* key) const;
  bool has(const char* key) const { return json_.contains(key); }
  JsonFields object(const char* key) const;
  std::string text(const char* key) const;
  bool flag(const char* key) const;
  uint64_t whole(const char* key, uint64_t most) const;
  /// At least 0, finite.
  double number(const char* key) const;
  /// The same; null is infinite.
  double number_or_infinite(const char* key) const;
  /// `count` numbers of at least 0, finite.
  std::vector<double> numbers(const char* key, size_t count) const;
  /// Base64 of exactly `count` values of T, little-endian.
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

/// What all files are parsed with: discarded where `text` is no JSON, or nested more than 32 deep. nlohmann copies and
/// writes what is nested by recursion, so a file must not choose how deep that goes.
JsonFields::Json parse_json(std::span<const uint8_t> text);
JsonFields::Json parse_json(const std::string& text);

/// Whether `json` is an object that says it is of this format.
bool is_of_format(const JsonFields::Json& json, const char* format);

}  // namespace velour

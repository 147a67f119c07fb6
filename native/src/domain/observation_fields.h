// Fields of an observation's JSON, each checked as it is read. Internal to domain/.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace velour {

/// Reads the members of one JSON object. What is not as it should be throws Error(bad_data) with file and field.
class ObservationFields {
 public:
  using Json = nlohmann::ordered_json;

  /// `name`: the file's; `path`: the object's place within it, "" or "hits.".
  ObservationFields(const Json& json, std::string name, std::string path = {});

  ObservationFields object(const char* key) const;
  std::string text(const char* key) const;
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
  const Json& at(const char* key) const;
  double number_of(const Json& json, const char* key) const;
  std::vector<uint8_t> bytes(const char* key, uint64_t count) const;

  const Json& json_;
  std::string name_, path_;
};

}  // namespace velour

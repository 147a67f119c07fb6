#include "domain/observation_fields.h"

#include <cmath>
#include <limits>

#include "file/base64.h"
#include "job/error.h"

namespace velour {

ObservationFields::ObservationFields(const Json& json, std::string name, std::string path)
    : json_(json), name_(std::move(name)), path_(std::move(path)) {}

void ObservationFields::fail(const std::string& key, const std::string& wanted) const {
  throw Error(Status::bad_data,
              name_ + ": '" + path_ + key + "' is not " + wanted + "; the file is damaged, observe the scene anew.");
}

const ObservationFields::Json& ObservationFields::at(const char* key) const {
  const auto found = json_.find(key);
  if (found == json_.end()) fail(key, "there");
  return *found;
}

ObservationFields ObservationFields::object(const char* key) const {
  const Json& json = at(key);
  if (!json.is_object()) fail(key, "an object");
  return {json, name_, path_ + key + "."};
}

std::string ObservationFields::text(const char* key) const {
  const Json& json = at(key);
  if (!json.is_string()) fail(key, "a text");
  return json.get<std::string>();
}

uint64_t ObservationFields::whole(const char* key, uint64_t most) const {
  const Json& json = at(key);
  if (!json.is_number_unsigned() || json.get<uint64_t>() > most) {
    fail(key, "a whole number from 0 to " + std::to_string(most));
  }
  return json.get<uint64_t>();
}

double ObservationFields::number_of(const Json& json, const char* key) const {
  const double value = json.is_number() ? json.get<double>() : -1.0;
  if (!(value >= 0.0) || !std::isfinite(value)) fail(key, "a finite number of at least 0");
  return value;
}

double ObservationFields::number(const char* key) const { return number_of(at(key), key); }

double ObservationFields::number_or_infinite(const char* key) const {
  return at(key).is_null() ? std::numeric_limits<double>::infinity() : number(key);
}

std::vector<double> ObservationFields::numbers(const char* key, size_t count) const {
  const Json& json = at(key);
  if (!json.is_array() || json.size() != count) fail(key, "a list of " + std::to_string(count) + " numbers");
  std::vector<double> out;
  for (const Json& entry : json) out.push_back(number_of(entry, key));
  return out;
}

std::vector<uint8_t> ObservationFields::bytes(const char* key, uint64_t count) const {
  const Json& json = at(key);
  if (!json.is_string()) fail(key, "base64 of " + std::to_string(count) + " bytes");
  auto bytes = parse_base64(json.get_ref<const std::string&>());
  if (!bytes || bytes->size() != count) fail(key, "base64 of " + std::to_string(count) + " bytes");
  return std::move(*bytes);
}

}  // namespace velour

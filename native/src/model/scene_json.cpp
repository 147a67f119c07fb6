#include "model/scene_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_fields.h"
#include "model/record_json.h"
#include "usage/observation_hash.h"

namespace velour {
namespace {

using Json = nlohmann::ordered_json;

constexpr uint32_t kMaxTexels = 1u << 20;  // per side of a tile; far beyond what a file holds

/// Writes the bins from the first to the last that was observed.
void write_views(const SceneDomain& domain, Json& json) {
  size_t begin = 0, end = domain.view.size();
  while (begin < end && domain.view[begin] == 0) ++begin;
  while (end > begin && domain.view[end - 1] == 0) --end;
  json["first_view"] = begin;
  json["view_weights"] = Json::array();
  for (size_t i = begin; i < end; ++i) json["view_weights"].push_back(four_digits(domain.view[i]));
}

Json weights_json(const auto& weights) {
  Json json = Json::array();
  for (const double weight : weights) json.push_back(four_digits(weight));
  return json;
}

/// Writes the bins that were observed.
void write_directions(const ViewWeights& views, Json& json) {
  Json bins = Json::array(), weights = Json::array();
  for (size_t i = 0; i < views.weight.size(); ++i) {
    if (views.weight[i] == 0) continue;
    bins.push_back(i);
    weights.push_back(four_digits(views.weight[i]));
  }
  if (!bins.empty()) json.update({{"direction_bins", bins}, {"direction_weights", weights}});
}

/// Writes the fields that a BTF's record has in addition to a BRDF's.
void write_surface(const SceneRecord& record, Json& json) {
  json["full_texels"] = record.full_texels;
  if (record.seen_views_alone) json["seen_views_alone"] = true;
  json["footprint_weights"] = weights_json(record.domain.surface.footprint);
  json["tile_weights"] = weights_json(record.domain.surface.tile);
  write_directions(record.domain.surface.views, json);
}

/// Reads keys and reports what is wrong with them, including missing ones.
class SceneReader {
 public:
  SceneReader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {}

  double number(const char* key) const { return number_of(at(key), key); }
  double number_or_infinite(const char* key) const {
    return at(key).is_null() ? std::numeric_limits<double>::infinity() : number(key);
  }
  uint64_t whole(const char* key) const {
    if (!at(key).is_number_unsigned()) fail(key, "a non-negative integer");
    return at(key).get<uint64_t>();
  }
  std::array<uint64_t, 4> hash(const char* key) const {
    const auto parsed = at(key).is_string() ? parse_hash(at(key).get<std::string>()) : std::nullopt;
    if (!parsed) fail(key, "64 hexadecimal digits");
    return *parsed;
  }
  void views(SceneDomain& domain) const {
    const uint64_t first = whole("first_view");
    const Json& weights = at("view_weights");
    if (!weights.is_array() || first > domain.view.size() || weights.size() > domain.view.size() - first) {
      fail("view_weights",
           "a list of at most " + std::to_string(domain.view.size()) + " weights, starting at 'first_view'");
    }
    for (size_t i = 0; i < weights.size(); ++i) domain.view[first + i] = number_of(weights[i], "view_weights");
  }
  void directions(ViewWeights& views) const {
    const Json& bins = at("direction_bins");
    const auto good = [&](const Json& bin) { return bin.is_number_unsigned() && bin < views.weight.size(); };
    if (!bins.is_array() || !std::ranges::all_of(bins, good)) {
      fail("direction_bins", "a list of integers below " + std::to_string(views.weight.size()));
    }
    const Json& weights = at("direction_weights");
    if (!weights.is_array() || weights.size() != bins.size()) {
      fail("direction_weights", "a list with as many weights as 'direction_bins'");
    }
    for (size_t i = 0; i < bins.size(); ++i) {
      views.weight[bins[i].get<size_t>()] = number_of(weights[i], "direction_weights");
    }
  }
  bool flag(const char* key) const {
    if (!at(key).is_boolean()) fail(key, "true or false");
    return at(key).get<bool>();
  }
  bool has(const char* key) const { return json_.contains(key); }
  void weights(const char* key, auto& to) const {
    const Json& json = at(key);
    if (!json.is_array() || json.size() != to.size()) fail(key, "a list of " + std::to_string(to.size()) + " weights");
    for (size_t i = 0; i < to.size(); ++i) to[i] = number_of(json[i], key);
  }
  std::array<uint32_t, 2> texels(const char* key) const {
    const Json& json = at(key);
    const auto good = [](const Json& n) { return n.is_number_unsigned() && n >= 1u && n <= kMaxTexels; };
    if (!json.is_array() || json.size() != 2 || !good(json[0]) || !good(json[1])) fail(key, "two positive integers");
    return {json[0].get<uint32_t>(), json[1].get<uint32_t>()};
  }

 private:
  const Json& at(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) fail(key, "present");
    return *found;
  }
  double number_of(const Json& v, const char* key) const {
    if (!v.is_number() || !std::isfinite(v.get<double>()) || v.get<double>() < 0) fail(key, "a number of at least 0");
    return v.get<double>();
  }
  [[noreturn]] void fail(const char* key, const std::string& wanted) const {
    throw Error(Status::bad_data, where_ + ": '" + key + "' must be " + wanted + "; the model file is damaged.");
  }

  const Json& json_;
  std::string where_;
};

}  // namespace

std::string scene_record_json(const SceneRecord& record) {
  const SceneDomain& domain = record.domain;
  const bool finite = std::isfinite(domain.light_density);
  Json json = {{"frames", domain.frames},
               {"camera_rays", domain.camera_rays},
               {"light_density", finite ? Json(domain.light_density) : Json(nullptr)},
               {"hash", hash_text(domain.hash)},
               {"picture_error", record.picture_error},
               {"full_picture_error", record.full_picture_error},
               {"full_parameter_bytes", record.full_parameter_bytes}};
  write_views(domain, json);
  if (record.full_texels[0] > 0) write_surface(record, json);
  return json.dump();
}

SceneRecord parse_scene_record(const std::string& text, const std::string& where) {
  const Json json = parse_json(text);
  if (!json.is_object()) throw Error(Status::bad_data, where + " is not a JSON object; the model file is damaged.");
  const SceneReader reader(json, where);
  SceneRecord record;
  record.domain.frames = reader.whole("frames");
  record.domain.camera_rays = reader.whole("camera_rays");
  record.domain.light_density = reader.number_or_infinite("light_density");
  record.domain.hash = reader.hash("hash");
  reader.views(record.domain);
  record.picture_error = reader.number("picture_error");
  record.full_picture_error = reader.number("full_picture_error");
  record.full_parameter_bytes = reader.whole("full_parameter_bytes");
  if (!reader.has("full_texels")) return record;
  record.full_texels = reader.texels("full_texels");
  record.seen_views_alone = reader.has("seen_views_alone") && reader.flag("seen_views_alone");
  reader.weights("footprint_weights", record.domain.surface.footprint);
  reader.weights("tile_weights", record.domain.surface.tile);
  if (reader.has("direction_bins")) reader.directions(record.domain.surface.views);
  return record;
}

}  // namespace velour

#include "model/file/record_json.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_fields.h"
#include "usage/observation.h"

namespace velour {

namespace {

using Json = nlohmann::ordered_json;

Json number_json(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

Json errors_json(const ErrorByViewAngle& errors) {
  Json json = Json::object();
  for (const auto& [angle, error] : errors) json[angle] = number_json(error);
  return json;
}

/// Reads keys of one object and reports what is wrong with them.
class FitRecordReader {
 public:
  FitRecordReader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {}

  void number(const char* key, double& out) const {
    if (const Json* v = find(key)) out = number_of(*v, key);
  }
  void number_or_null(const char* key, std::optional<double>& out) const {
    const Json* v = find(key);
    if (v && !v->is_null()) out = number_of(*v, key);
  }
  void integer(const char* key, uint64_t& out) const {
    const Json* v = find(key);
    if (v && !v->is_number_unsigned()) fail(key, "a non-negative integer");
    if (v) out = v->get<uint64_t>();
  }
  void boolean(const char* key, bool& out) const {
    const Json* v = find(key);
    if (v && !v->is_boolean()) fail(key, "true or false");
    if (v) out = v->get<bool>();
  }
  void errors(const char* key, ErrorByViewAngle& out) const {
    const Json* v = find(key);
    if (v && !v->is_object()) fail(key, "an object");
    if (!v) return;
    for (const auto& [angle, error] : v->items()) {
      out[angle] = error.is_null() ? std::nullopt : std::optional(number_of(error, key));
    }
  }
  void order(const char* key, OrderCurve& out) const {
    if (const Json* v = find(key)) out = parse_order(*v, where_ + ": '" + key + "'");
  }
  void verdict(const char* key, std::optional<Verdict>& out) const {
    if (const Json* v = find(key)) out = parse_verdict(*v, where_ + ": '" + key + "'");
  }

 private:
  const Json* find(const char* key) const {
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }
  double number_of(const Json& v, const char* key) const {
    if (!v.is_number() || !std::isfinite(v.get<double>()) || v.get<double>() < 0) fail(key, "a number of at least 0");
    return v.get<double>();
  }
  [[noreturn]] void fail(const char* key, const char* wanted) const {
    throw Error(Status::bad_data, where_ + ": '" + key + "' must be " + wanted + "; the model file is damaged.");
  }

  const Json& json_;
  std::string where_;
};

}  // namespace

std::string fit_record_json(const FitRecord& record) {
  Json json = {{"relative_l2", record.relative_l2},
               {"by_view_angle", errors_json(record.by_view_angle)},
               {"albedo_by_view_angle", errors_json(record.albedo_by_view_angle)},
               {"albedo_max", record.albedo_max},
               {"reciprocity", record.reciprocity},
               {"measured_reciprocity", number_json(record.measured_reciprocity)},
               {"tolerance", record.tolerance},
               {"seed", record.seed},
               {"all_data", record.all_data}};
  put_warnings(record.warnings, json);
  if (!record.order.points.empty()) json["order"] = order_json(record.order);
  if (record.verdict) json["verdict"] = verdict_json(*record.verdict);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

FitRecord parse_fit_record(const std::string& text, const std::string& where) {
  const Json json = parse_json(text);
  if (!json.is_object()) throw Error(Status::bad_data, where + " is not a JSON object; the model file is damaged.");
  const FitRecordReader reader(json, where);
  FitRecord record;
  reader.number("relative_l2", record.relative_l2);
  reader.errors("by_view_angle", record.by_view_angle);
  reader.errors("albedo_by_view_angle", record.albedo_by_view_angle);
  reader.number("albedo_max", record.albedo_max);
  reader.number("reciprocity", record.reciprocity);
  reader.number_or_null("measured_reciprocity", record.measured_reciprocity);
  reader.number("tolerance", record.tolerance);
  reader.integer("seed", record.seed);
  reader.boolean("all_data", record.all_data);
  record.warnings = parse_warnings(json, where);
  reader.order("order", record.order);
  reader.verdict("verdict", record.verdict);
  return record;
}

namespace {

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

namespace {

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

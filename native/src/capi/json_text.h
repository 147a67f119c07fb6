// Helpers shared by all reports of the C interface.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "brdf/measure/measurement.h"
#include "btf/measure/btf_measurement.h"
#include "model/model.h"

namespace velour::capi {

using Json = nlohmann::ordered_json;

/// Serializes `json`. nlohmann writes NaN as null; invalid UTF-8 (in file names) is replaced instead of throwing.
inline std::string text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

inline Json or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

/// Meters along x and y; null if unknown.
inline Json tile_json(const TexelGrid& grid) {
  return grid.tile_metres ? Json{grid.tile_metres->x, grid.tile_metres->y} : Json(nullptr);
}

/// The first keys of all reports on measurements and BTFs.
inline Json source_json(const char* kind, const Provenance& p) {
  return {{"kind", kind},         {"format", p.format},           {"name", p.name},
          {"path", p.path},       {"description", p.description}, {"sha256", p.sha256},
          {"bytes", p.file_bytes}};
}

template <class Measured>
Json details_json(const Measured& measured) {
  Json details = Json::object();
  for (const auto& [key, value] : measured.details()) details[key] = value;
  return details;
}

/// Relative errors by view angle in degrees, in numerical rather than textual order.
inline Json by_view_angle(const ErrorByViewAngle& errors) {
  Json json = Json::object();
  for (const char* angle : {"5", "30", "60", "75", "85"}) {
    const auto found = errors.find(angle);
    json[angle] = found != errors.end() ? or_null(found->second) : Json(nullptr);
  }
  return json;
}

inline Json views_json(const ViewRange& views) { return {views.begin, views.end}; }

inline Json color(const Rgb& c) { return {c.r, c.g, c.b}; }

}  // namespace velour::capi

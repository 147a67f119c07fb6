// What all reports of the C interface share.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "brdf/measurement.h"
#include "btf/btf_measurement.h"
#include "model/model.h"

namespace velour::capi {

using Json = nlohmann::ordered_json;

/// nlohmann writes NaN as null by itself; bytes that are not UTF-8 (file names) are replaced instead of thrown on.
inline std::string text(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

inline Json or_null(const std::optional<double>& number) { return number ? Json(*number) : Json(nullptr); }

/// Metres along x and y; null where they are not known.
inline Json tile_json(const TexelGrid& grid) {
  return grid.tile_metres ? Json{grid.tile_metres->x, grid.tile_metres->y} : Json(nullptr);
}

/// The first keys of everything that was measured.
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

/// Relative errors by view angle, degrees, in the order of the angles and not of their texts.
inline Json by_view_angle(const ErrorByViewAngle& errors) {
  Json json = Json::object();
  for (const char* angle : {"5", "30", "60", "75", "85"}) {
    const auto found = errors.find(angle);
    json[angle] = found != errors.end() ? or_null(found->second) : Json(nullptr);
  }
  return json;
}

inline Json views_json(const ViewRange& views) { return {views.begin, views.end}; }

inline Json colour(const Rgb& c) { return {c.r, c.g, c.b}; }

}  // namespace velour::capi

// Reports as JSON, with the keys of the command line.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>
#include "brdf/fit/closures/closure_fit.h"
#include "brdf/fit/error/compare.h"
#include "brdf/fit/peer.h"
#include "brdf/measure/measurement.h"
#include "btf/fit/btf_compare.h"
#include "btf/formats/btf_export.h"
#include "btf/measure/btf_measurement.h"
#include "capture/btf/btf_capture.h"
#include "capture/goniometer/microsurface.h"
#include "capture/tile/tile.h"
#include "model/model.h"
#include "model/records.h"
#include "render/render.h"
#include "scene/scene.h"
#include "usage/observation.h"
#include "usage/scene_domain.h"

namespace velour::capi {

// Helpers shared by all reports of the C interface.

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

// JSON reports on fits and their errors, with the keys of the verbs (docs/reference/cli_measurements.md).

std::string fit_json(const Model& model, uint64_t file_bytes);
std::string comparison_json(const Comparison& comparison, const std::optional<Verdict>& verdict);
std::string peer_json(const PeerFit& fit);
/// With the inputs of Blender's nodes (vlr_model_closures_json).
std::string closures_json(const ModelClosures& closures);

// JSON reports on models, with the keys of the command line's verbs (docs/reference/cli_files.md).

/// Number of lobes or components of a model, and its sizes in bytes.
Json size_json(const Model& model, uint64_t file_bytes);

std::string model_json(const Model& model, uint64_t file_bytes);
/// Report on a VOTF that took `seconds` to compute.
std::string votf_json(const ModelShell& shell, double seconds, const std::vector<Warning>& warnings);

// JSON reports on BTFs, with the keys of the command line's verbs (docs/reference/cli_btf.md).

/// Reads a few pairs to count their values, unless these have been counted.
std::string btf_json(const BtfMeasurement& btf);
std::string btf_export_json(const BtfExportReport& report);
/// Report on the fit of a BTF's model.
std::string compression_json(const Model& model, uint64_t file_bytes);
std::string btf_errors_json(const BtfErrors& errors, double p99);

// JSON reports on virtual measurements, with the keys of the command line's verbs (docs/reference/cli_btf.md).

std::string capture_json(const BtfCaptureReport& report);
std::string microsurface_json(const MicrosurfaceReport& report);

// JSON reports on procedural mesostructure, with the keys of the command line's verbs (docs/reference/cli_btf.md).

std::string tile_json(const Tile& tile);
std::string tile_kinds_json();

// JSON reports on scene usage, and on scene models.

/// Keys of a scene model.
Json reduced_json(const SceneRecord& scene);

/// Usage of a material that varies over its surface.
Json surface_json(const SurfaceDomain& surface);

std::string observation_json(const SceneObservation& observation);
/// Report of the job that made the observation, which took `seconds`.
std::string observe_json(const SceneObservation& observation, double seconds);

// JSON reports on scenes and renders, with the keys of the command line's verbs (docs/reference/cli_render.md).

std::string scene_json(const Scene& scene);
std::string render_json(const RenderReport& report);

}  // namespace velour::capi

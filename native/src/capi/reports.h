// JSON texts of the library's records: the keys of the command line's verbs (docs/command_line.md).
#pragma once

#include <string>

#include "brdf/measurement.h"
#include "capture/btf_capture.h"
#include "capture/microsurface.h"
#include "domain/observation.h"
#include "fit/compare.h"
#include "fit/peer.h"
#include "model/model.h"
#include "render/report.h"
#include "scene/scene.h"
#include "tile/tile.h"

namespace velour::capi {

std::string system_json();
std::string measurement_json(const Measurement& measurement);
std::string model_json(const Model& model, uint64_t file_bytes);
std::string fit_json(const Model& model, uint64_t file_bytes);
std::string comparison_json(const Comparison& comparison);
std::string peer_json(const PeerFit& fit);
std::string capture_json(const BtfCaptureReport& report);
std::string votf_json(const ModelShell& shell, double seconds, const std::vector<std::string>& warnings);
std::string microsurface_json(const MicrosurfaceReport& report);
std::string scene_json(const Scene& scene);
std::string render_json(const RenderReport& report);
std::string observation_json(const SceneObservation& observation);
/// The same of the job that made it, which took `seconds`.
std::string observe_json(const SceneObservation& observation, double seconds);

std::string tile_json(const Tile& tile);
std::string tile_kinds_json();

}  // namespace velour::capi

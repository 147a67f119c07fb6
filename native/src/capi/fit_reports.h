// JSON reports on fits and their errors, with the keys of the verbs (docs/reference/cli_measurements.md).
#pragma once

#include <optional>
#include <string>
#include <vector>
#include "brdf/fit/closures/model_closures.h"
#include "brdf/fit/error/compare.h"
#include "brdf/fit/peer.h"
#include "capi/json_text.h"
#include "model/model.h"

namespace velour::capi {

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

}  // namespace velour::capi

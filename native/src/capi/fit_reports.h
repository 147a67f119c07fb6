// JSON reports on fits and their errors, with the keys of the command line's verbs (docs/command_line.md).
#pragma once

#include <string>

#include "fit/compare.h"
#include "fit/peer.h"
#include "model/model.h"

namespace velour::capi {

std::string fit_json(const Model& model, uint64_t file_bytes);
std::string comparison_json(const Comparison& comparison);
std::string peer_json(const PeerFit& fit);

}  // namespace velour::capi

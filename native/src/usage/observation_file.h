// Observation files: JSON with readable numbers; hits and their terms are base64
// (docs/reference/measurement_formats.md).
#pragma once

#include <span>
#include <string>

#include "usage/observation.h"

namespace velour {

/// All numbers survive a round trip bit by bit.
std::string encode_observation(const SceneObservation& observation);

/// Throws Error(bad_data), or Error(version_mismatch) for another version of the format. The message names the file
/// (`name`) and the field at fault.
SceneObservation decode_observation(std::span<const uint8_t> bytes, const std::string& name);

/// Writes atomically.
void save_observation(const SceneObservation& observation, const std::string& path);
SceneObservation load_observation(const std::string& path);

/// Whether the file begins like the JSON of an observation; the rest may still be damaged.
bool is_observation_file(const std::string& path);

}  // namespace velour

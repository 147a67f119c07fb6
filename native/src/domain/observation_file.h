// Observations as files: JSON with readable numbers, the hits and their terms as base64 (docs/formats.md).
#pragma once

#include <span>
#include <string>

#include "domain/observation.h"

namespace velour {

/// The bits of all numbers survive a round trip.
std::string encode_observation(const SceneObservation& observation);

/// Throws Error(bad_data), or Error(version_mismatch) for a later version of the format, with `name` (the file's, for
/// sentences) and the field at fault.
SceneObservation decode_observation(std::span<const uint8_t> bytes, const std::string& name);

/// Writes atomically.
void save_observation(const SceneObservation& observation, const std::string& path);
SceneObservation load_observation(const std::string& path);

/// Whether the file begins as the JSON of an observation does; what follows may still be damaged.
bool is_observation_file(const std::string& path);

}  // namespace velour

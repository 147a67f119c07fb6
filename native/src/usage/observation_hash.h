// Content hash of an observation.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include "usage/observation.h"

namespace velour {

/// SHA-256 of the view histogram, the light density, the surface usage if there is any, and the hits with their terms,
/// as four words. For the domain of one frame; merging adds the words up.
std::array<uint64_t, 4> content_hash(const SceneObservation& observation);

// The four words of a domain's hash as 64 hexadecimal digits, first word first.

std::string hash_text(const std::array<uint64_t, 4>& hash);

/// Empty unless `text` consists of 64 digits 0-9, a-f.
std::optional<std::array<uint64_t, 4>> parse_hash(std::string_view text);

}  // namespace velour

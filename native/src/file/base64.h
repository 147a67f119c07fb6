// Bytes as text [RFC 4648, section 4], for binary arrays within JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace velour {

std::string base64(std::span<const uint8_t> bytes);

/// Nothing unless `text` is what base64() makes of some bytes: no blanks, no line breaks, padded, spare bits zero.
std::optional<std::vector<uint8_t>> parse_base64(std::string_view text);

}  // namespace velour

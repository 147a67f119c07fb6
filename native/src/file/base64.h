// Base64 [RFC 4648, section 4], for binary arrays in JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace velour {

std::string base64(std::span<const uint8_t> bytes);

/// Empty unless `text` is an exact result of base64(): no blanks or line breaks, padded, spare bits zero.
std::optional<std::vector<uint8_t>> parse_base64(std::string_view text);

}  // namespace velour

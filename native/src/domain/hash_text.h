// The four words of a domain's hash as 64 hexadecimal digits, first word first.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace velour {

std::string hash_text(const std::array<uint64_t, 4>& hash);

/// Empty unless `text` consists of 64 digits 0-9, a-f.
std::optional<std::array<uint64_t, 4>> parse_hash(std::string_view text);

}  // namespace velour

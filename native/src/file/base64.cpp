#include "file/base64.h"

#include <algorithm>
#include <array>

namespace velour {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr uint8_t kNoDigit = 64;

constexpr std::array<uint8_t, 256> kValues = [] {
  std::array<uint8_t, 256> values{};
  values.fill(kNoDigit);
  for (size_t i = 0; i < kDigits.size(); ++i) values[static_cast<uint8_t>(kDigits[i])] = static_cast<uint8_t>(i);
  return values;
}();

/// Appends up to three bytes as four characters.
void append_group(std::string& text, std::span<const uint8_t> bytes) {
  uint32_t bits = 0;
  for (size_t i = 0; i < 3; ++i) bits = bits << 8 | (i < bytes.size() ? bytes[i] : 0u);
  for (size_t i = 0; i < 4; ++i) text += i <= bytes.size() ? kDigits[bits >> (18 - 6 * i) & 63] : '=';
}

/// Decodes four characters, the first `digits` of which are not padding. Returns false if they are invalid.
bool append_bytes(std::vector<uint8_t>& bytes, std::string_view group, size_t digits) {
  uint32_t bits = 0;
  for (size_t i = 0; i < 4; ++i) {
    const uint8_t value = i < digits ? kValues[static_cast<uint8_t>(group[i])] : uint8_t{0};
    if (value == kNoDigit) return false;
    bits = bits << 6 | value;
  }
  for (size_t i = 0; i + 1 < digits; ++i) bytes.push_back(static_cast<uint8_t>(bits >> (16 - 8 * i)));
  const uint32_t spare = digits == 4 ? 0u : bits & ((1u << (8 * (4 - digits))) - 1u);
  return spare == 0;
}

}  // namespace

std::string base64(std::span<const uint8_t> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    append_group(text, bytes.subspan(i, std::min<size_t>(3, bytes.size() - i)));
  }
  return text;
}

std::optional<std::vector<uint8_t>> parse_base64(std::string_view text) {
  if (text.size() % 4 != 0) return std::nullopt;
  std::vector<uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3);
  for (size_t i = 0; i < text.size(); i += 4) {
    const std::string_view group = text.substr(i, 4);
    const bool last = i + 4 == text.size();
    const size_t digits = !last || group[3] != '=' ? 4 : group[2] != '=' ? 3 : 2;
    if (!append_bytes(bytes, group, digits)) return std::nullopt;
  }
  return bytes;
}

}  // namespace velour

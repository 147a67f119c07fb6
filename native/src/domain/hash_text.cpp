#include "domain/hash_text.h"

namespace velour {
namespace {

constexpr std::string_view kHex = "0123456789abcdef";

}  // namespace

std::string hash_text(const std::array<uint64_t, 4>& hash) {
  std::string text;
  for (const uint64_t word : hash) {
    for (int shift = 60; shift >= 0; shift -= 4) text += kHex[word >> shift & 15];
  }
  return text;
}

std::optional<std::array<uint64_t, 4>> parse_hash(std::string_view text) {
  if (text.size() != 64) return std::nullopt;
  std::array<uint64_t, 4> hash{};
  for (size_t i = 0; i < text.size(); ++i) {
    const size_t digit = kHex.find(text[i]);
    if (digit == std::string_view::npos) return std::nullopt;
    hash[i / 16] = hash[i / 16] << 4 | digit;
  }
  return hash;
}

}  // namespace velour

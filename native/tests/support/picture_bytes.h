// Parts of picture files, written byte by byte.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace velour::test {

using Bytes = std::vector<uint8_t>;

inline void append(Bytes& to, uint64_t value, size_t count, bool big_endian = true) {
  for (size_t i = 0; i < count; ++i)
    to.push_back(static_cast<uint8_t>(value >> (8 * (big_endian ? count - 1 - i : i))));
}

inline void append(Bytes& to, std::string_view text) { to.insert(to.end(), text.begin(), text.end()); }

inline uint32_t crc_of(std::span<const uint8_t> bytes) {
  uint32_t crc = ~0u;
  for (const uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320u : 0);
  }
  return ~crc;
}

/// `png` with a chunk after its header.
inline Bytes with_chunk(const Bytes& png, std::string_view type, const Bytes& data) {
  constexpr std::ptrdiff_t kHeaderEnd = 8 + 12 + 13;
  Bytes chunk(type.begin(), type.end()), result(png.begin(), png.begin() + kHeaderEnd);
  chunk.insert(chunk.end(), data.begin(), data.end());
  append(result, data.size(), 4);
  result.insert(result.end(), chunk.begin(), chunk.end());
  append(result, crc_of(chunk), 4);
  result.insert(result.end(), png.begin() + kHeaderEnd, png.end());
  return result;
}

}  // namespace velour::test

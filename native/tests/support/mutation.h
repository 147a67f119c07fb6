// Damage for files, as parsers meet it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "math/sphere/random.h"

namespace velour::test {

/// One small change of the kinds that break parsers: flipped bits, sizes at the edge of their type, cuts, repeats.
inline void mutate(std::vector<uint8_t>& bytes, RandomStream& random) {
  if (bytes.empty()) return;
  const auto below = [&](size_t n) { return static_cast<size_t>(random.next_bits() % n); };
  const size_t at = below(bytes.size());
  constexpr uint64_t kEdges[] = {0,
                                 1,
                                 2,
                                 0x7f,
                                 0xff,
                                 0x7fff,
                                 0xffff,
                                 0x7fffffff,
                                 0x80000000,
                                 0xffffffff,
                                 uint64_t{1} << 40,
                                 uint64_t{1} << 62,
                                 uint64_t{1} << 63,
                                 ~uint64_t{0},
                                 0x7fc00000,
                                 0x7f800000};
  switch (below(6)) {
    case 0:
      bytes[at] = static_cast<uint8_t>(bytes[at] ^ (1u << below(8)));
      break;
    case 1:
      bytes[at] = static_cast<uint8_t>(random.next_bits());
      break;
    case 2:
      bytes.resize(at);
      break;
    case 3: {
      const uint64_t edge = kEdges[below(std::size(kEdges))];
      const size_t size = size_t{1} << below(4);
      for (size_t i = 0; i < size && at + i < bytes.size(); ++i) bytes[at + i] = static_cast<uint8_t>(edge >> (8 * i));
      break;
    }
    case 4: {
      const size_t from = below(bytes.size()), count = below(std::min<size_t>(64, bytes.size() - std::max(from, at)));
      const std::vector<uint8_t> before = bytes;
      for (size_t i = 0; i < count; ++i) bytes[at + i] = before[from + i];
      break;
    }
    default:
      bytes[at] = static_cast<uint8_t>("0123456789.-#enai \n"[below(19)]);
      break;
  }
}

}  // namespace velour::test

#include "render/film/cryptomatte.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include "render/film/pass_layout.h"

namespace velour {

namespace {

uint32_t scrambled(uint32_t block) { return std::rotl(block * 0xcc9e2d51u, 15) * 0x1b873593u; }

/// `count` bytes from `first`, in little-endian order.
uint32_t block_at(std::string_view name, size_t first, size_t count) {
  uint32_t block = 0;
  for (size_t i = 0; i < count; ++i) {
    block |= static_cast<uint32_t>(static_cast<unsigned char>(name[first + i])) << (8 * i);
  }
  return block;
}

}  // namespace

uint32_t murmur_hash(std::string_view name) {
  const size_t whole = name.size() / 4 * 4;
  uint32_t hash = 0;
  for (size_t i = 0; i < whole; i += 4) {
    hash = std::rotl(hash ^ scrambled(block_at(name, i, 4)), 13) * 5 + 0xe6546b64u;
  }
  hash ^= scrambled(block_at(name, whole, name.size() - whole));
  hash ^= static_cast<uint32_t>(name.size());
  hash = (hash ^ (hash >> 16)) * 0x85ebca6bu;
  hash = (hash ^ (hash >> 13)) * 0xc2b2ae35u;
  return hash ^ (hash >> 16);
}

float cryptomatte_id(std::string_view name) {
  const uint32_t hash = murmur_hash(name), exponent = (hash >> 23) & 255;
  const bool unusual = exponent == 0 || exponent == 255;
  return std::bit_cast<float>(unusual ? hash ^ (1u << 23) : hash);
}

void add_id(float id, float weight, std::span<float> slots) {
  if (id == 0.0f || !(weight > 0.0f)) return;
  for (size_t i = 0; i + 1 < slots.size(); i += 2) {
    if (slots[i] != 0.0f && slots[i] != id) continue;
    slots[i] = id;
    slots[i + 1] += weight;
    return;
  }
}

void write_ids(std::span<const float> slots, int first, float scale, float out[4]) {
  struct Rank {
    float id, weight;
  };
  Rank ranks[floats_of_ids(PassOptions::kMaxRanks) / 2] = {};
  size_t count = 0;
  for (size_t i = 0; i + 1 < slots.size() && slots[i] != 0.0f; i += 2) ranks[count++] = {slots[i], slots[i + 1]};
  std::sort(ranks, ranks + count,
            [](const Rank& a, const Rank& b) { return a.weight != b.weight ? a.weight > b.weight : a.id < b.id; });
  for (int k = 0; k < 2; ++k) {
    out[2 * k] = ranks[first + k].id;
    out[2 * k + 1] = ranks[first + k].weight * scale;
  }
}

}  // namespace velour

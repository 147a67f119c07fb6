#include "usage/observation_hash.h"

#include <span>
#include "base/file.h"

namespace velour {

namespace {

template <typename T>
void append(std::vector<uint8_t>& bytes, std::span<const T> values) {
  const auto raw = std::as_bytes(values);
  const auto* first = reinterpret_cast<const uint8_t*>(raw.data());
  bytes.insert(bytes.end(), first, first + raw.size());
}

/// ObservedHit without padding, whose bytes are undefined.
struct PackedHit {
  uint64_t key;
  float wv[3], light_density;
  uint32_t first, middle, last, back;
};
static_assert(sizeof(PackedHit) == 40);

PackedHit packed(const ObservedHit& hit) {
  return {hit.key, {hit.wv.x, hit.wv.y, hit.wv.z}, hit.light_density, hit.first, hit.middle, hit.last, hit.back};
}

}  // namespace

std::array<uint64_t, 4> content_hash(const SceneObservation& observation) {
  std::vector<PackedHit> hits;
  for (const ObservedHit& hit : observation.hits) hits.push_back(packed(hit));
  std::vector<uint8_t> bytes;
  append(bytes, std::span<const double>(observation.domain.view));
  append(bytes, std::span<const double>(&observation.domain.light_density, 1));
  if (observation.domain.surface.weight() > 0) {  // keeps the older hashes of uniform materials
    append(bytes, std::span<const double>(observation.domain.surface.footprint));
    append(bytes, std::span<const double>(observation.domain.surface.tile));
    append(bytes, std::span<const double>(observation.domain.surface.views.weight));
  }
  append(bytes, std::span<const PackedHit>(hits));
  append(bytes, std::span<const Vec3>(observation.wl));
  append(bytes, std::span<const Rgb>(observation.light));
  return *parse_hash(sha256_hex(bytes));
}

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

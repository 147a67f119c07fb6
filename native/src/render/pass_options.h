// Passes of a film beyond those that every film has, and the scene data that they show.
#pragma once

#include <cstdint>
#include <vector>

namespace velour {

/// Bits of PassOptions::asked; same values as in velour.h.
namespace pass {
inline constexpr uint32_t kPosition = 1, kUv = 2, kObjectIndex = 4, kMaterialIndex = 8, kMist = 16, kAlbedo = 32,
                          kError = 64, kCryptoObject = 128, kCryptoMaterial = 256, kCryptoAsset = 512,
                          kDenoisingAlbedo = 1024, kHalves = 2048;
inline constexpr uint32_t kAll = 4095;
/// Passes that depend on what a camera ray hits.
inline constexpr uint32_t kOfSurfaces = kAll & ~kError;
}  // namespace pass

/// Labels of an instance. Ids are those of names (cryptomatte_id.h).
struct InstanceLabel {
  float index = 0;
  float object_id = 0, asset_id = 0;
  int uv_set = -1;  // index of the mesh's texture coordinates for the UV pass; -1: it has none
};

struct MaterialLabel {
  float index = 0;
  float id = 0;
};

/// Grows from 0 to 1 over `depth` meters from `start`: the fraction of that distance to the power of `exponent`.
struct Mist {
  float start = 5, depth = 25, exponent = 2;

  /// 0..1. A depth of 0 means no mist, as in Cycles.
  float at(float distance) const;
};

struct PassOptions {
  static constexpr int kMostRanks = 16;

  uint32_t asked = 0;
  int cryptomatte_ranks = 6;  // ids per pixel; 2..kMostRanks
  Mist mist;
  /// Indexed as in the scene; missing ones have the default.
  std::vector<InstanceLabel> instances;
  std::vector<MaterialLabel> materials;

  bool has(uint32_t some) const { return (asked & some) != 0; }
};

}  // namespace velour

// The passes that a film has beyond those that every film has, and what they say of the scene.
#pragma once

#include <cstdint>
#include <vector>

namespace velour {

/// Bits of PassOptions::asked, and values of velour.h.
namespace pass {
inline constexpr uint32_t kPosition = 1, kUv = 2, kObjectIndex = 4, kMaterialIndex = 8, kMist = 16, kAlbedo = 32,
                          kError = 64, kCryptoObject = 128, kCryptoMaterial = 256, kCryptoAsset = 512,
                          kDenoisingAlbedo = 1024, kHalves = 2048;
inline constexpr uint32_t kAll = 4095;
/// Those that need to know what a camera ray meets.
inline constexpr uint32_t kOfSurfaces = kAll & ~kError;
}  // namespace pass

/// Of an instance. Ids are those of names (cryptomatte_id.h).
struct InstanceLabel {
  float index = 0;
  float object_id = 0, asset_id = 0;
  int uv_set = -1;  // of the mesh's sets of texture coordinates the one of the UV pass; -1: it has none
};

struct MaterialLabel {
  float index = 0;
  float id = 0;
};

/// Grows from 0 to 1 over `depth` metres from `start`, by the share of that way to the power of `exponent`.
struct Mist {
  float start = 5, depth = 25, exponent = 2;

  /// 0..1. Without depth there is none, as in Cycles.
  float at(float distance) const;
};

struct PassOptions {
  static constexpr int kMostRanks = 16;

  uint32_t asked = 0;
  int cryptomatte_ranks = 6;  // ids a pixel; 2..kMostRanks
  Mist mist;
  /// By their numbers in the scene; those beyond have the default.
  std::vector<InstanceLabel> instances;
  std::vector<MaterialLabel> materials;

  bool has(uint32_t some) const { return (asked & some) != 0; }
};

}  // namespace velour

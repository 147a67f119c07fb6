// Storage of the additional passes of a pixel.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>
#include "render/film/camera_sample.h"

namespace velour {

// Passes of a film beyond those that every film has, and the scene data that they show.

/// Bits of PassOptions::asked; same values as in velour.h.
namespace pass {
inline constexpr uint32_t kPosition = 1, kUv = 2, kObjectIndex = 4, kMaterialIndex = 8, kMist = 16, kAlbedo = 32,
                          kError = 64, kCryptoObject = 128, kCryptoMaterial = 256, kCryptoAsset = 512,
                          kDenoisingAlbedo = 1024, kHalves = 2048, kVector = 4096;
inline constexpr uint32_t kAll = 8191;
/// Passes that depend on what a camera ray hits.
inline constexpr uint32_t kOfSurfaces = kAll & ~kError;
}  // namespace pass

/// Labels of an instance. Ids are those of names (cryptomatte.h).
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
  static constexpr int kMaxRanks = 16;

  uint32_t asked = 0;
  int cryptomatte_ranks = 6;  // ids per pixel; 2..kMaxRanks
  Mist mist;
  /// Indexed as in the scene; missing ones have the default.
  std::vector<InstanceLabel> instances;
  std::vector<MaterialLabel> materials;

  bool has(uint32_t some) const { return (asked & some) != 0; }
};

/// Floats per pixel of the requested passes, stored one after the other.
class PassLayout {
 public:
  /// Throws Error(invalid_argument) for invalid `options`.
  explicit PassLayout(const PassOptions& options);

  /// Floats per pixel.
  size_t size() const { return size_; }

  /// Channels of a pass, requested or not; 0: there is none of that name. "Position" 3 (world, of the first camera
  /// ray), "UV" 3 (mean; the last: share with texture coordinates), "IndexOB" 1, "IndexMA" 1 (of the first camera ray),
  /// "Mist" 1, "Albedo" 3, "Error" 3, "Denoising Albedo" 3, "Halves" 18 (color, denoising albedo and normal of the even
  /// camera rays, 3 each; then of the odd ones), "Vector" 4 (SurfaceSample::from_previous and to_next, mean over the
  /// camera rays that hit something); "CryptoObject00", "CryptoObject01", ..., "CryptoMaterial..",
  /// "CryptoAsset.." 4: two ids, each followed by its coverage.
  static int channels(std::string_view pass);
  bool has(std::string_view pass) const;

  /// Adds a camera ray that follows those summed in `before`.
  void add(const SurfaceSample& surface, const CameraSample& sample, const PixelSum& before, float* values) const;
  /// Adds the camera rays summed in `later`, which follow those summed in `before`.
  void join(const PixelSum& before, std::span<float> values, const PixelSum& later,
            std::span<const float> later_values) const;
  /// Writes the channels of a requested pass, pixel by pixel; `values` holds size() floats per pixel.
  void write(std::string_view pass, std::span<const PixelSum> sums, std::span<const float> values, float* out) const;

 private:
  size_t floats(uint32_t pass) const;
  size_t place(uint32_t pass) const;

  uint32_t asked_;
  int ranks_;
  size_t size_ = 0;
};

}  // namespace velour

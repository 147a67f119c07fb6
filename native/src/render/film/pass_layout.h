// Results of camera rays, and the storage of the additional passes of a pixel.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>
#include "math/sphere/vec.h"

namespace velour {

// Results of camera rays, and their sums.

/// Result of one camera ray.
struct CameraSample {
  Rgb radiance{0.0f};
  float alpha = 0;      // 1: covered
  Vec3 normal{0.0f};    // shading normal, world; zero where nothing was hit
  float depth = 1e10f;  // along the camera's viewing axis; 1e10 where nothing was hit, as in Cycles
  int directions = 0;   // number of light directions of the ray
};

/// Sums of the samples of a pixel. Samples must be added in the order of their camera rays, so that the bits do not
/// depend on how the rays are distributed over passes and threads.
struct PixelSum {
  Rgb radiance{0.0f};
  float alpha = 0;
  Vec3 normal{0.0f};
  float depth = 0;              // depth of the first camera ray, as in Cycles: a mean of depths lies on no surface
  float luminance[2] = {0, 0};  // sums over the even and the odd camera rays: the halves (path_numbers.h)
  uint32_t camera_rays = 0, directions = 0;

  void add(const CameraSample& sample);
  /// Adds the sum of the camera rays that follow these.
  void join(const PixelSum& later);

  /// Factor from a sum over the camera rays to their mean; 0 without camera rays.
  float weight() const { return camera_rays > 0 ? 1.0f / static_cast<float>(camera_rays) : 0.0f; }
  double mean_luminance() const;
  /// Estimate of the variance of mean_luminance(), from the difference of the halves. Unbiased if the halves are
  /// independent; too high if they are parts of one Sobol sequence, which is more even than its parts. The
  /// stratification within a half (a Sobol sequence errs far less than independent samples) is accounted for. One
  /// degree of freedom: average it over pixels. Needs two camera rays.
  double variance() const;
};

/// Values that one camera ray contributes to the surface passes. Defaults: nothing was hit, before a black environment.
struct SurfaceSample {
  Vec3 position{0.0f};  // world
  Vec3 uv{0.0f};        // u, v, and 1 if there are texture coordinates
  float object_index = 0, material_index = 0;
  float seen = 0;   // throughput of the path up to there, mean of the channels
  float clear = 0;  // the part of `seen` that is not covered by mist
  Rgb albedo{0.0f};
  Rgb shine{0.0f};  // emission of the surface, or of the environment where nothing was hit
  float object_id = 0, material_id = 0, asset_id = 0;
  /// Motion in the image, pixels: place in the previous frame minus this place; this place minus that in the next
  /// frame.
  Vec2 from_previous{0.0f}, to_next{0.0f};
  float surfaces = 0;  // 1 where something was hit
};

// Storage of the additional passes of a pixel.

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

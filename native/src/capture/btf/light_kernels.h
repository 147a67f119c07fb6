// SIMD kernels for pairs of a place and a light.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "capture/btf/path_vertices.h"
#include "math/sphere/directions.h"
#include "math/sphere/frame.h"

namespace velour {

/// Normals of many places, one array per component.
class PlaceNormals {
 public:
  void clear() { count_ = 0; }
  void push(const Vec3& geometric, const Vec3& shading);
  size_t count() const { return count_; }
  const float* component(size_t c) const { return components_[c].data(); }

 private:
  size_t count_ = 0;
  std::array<std::vector<float>, 6> components_;  // padded to whole vectors
};

/// Finds the numbers, ascending, of the places whose geometric and shading normals both face `wl`.
void facing_places(const PlaceNormals& normals, const Vec3& wl, std::vector<uint32_t>& numbers);

/// Lights that reach a place, stored contiguously.
struct LitLights {
  DirectionBatch wl;                                          // local, padded
  uint32_t number[DirectionBatch::kCapacity];                 // in the group
  alignas(64) float weight[DirectionBatch::kCapacity] = {0};  // factor of f: wl.z per_irradiance
};

/// Collects the lights in [first, first + 64) of `group` whose bit in `mask` is set.
void collect_lit(const LightGroup& group, uint32_t first, uint64_t mask, const Frame& frame, LitLights& lit);

/// Sums over paths for each light of a group.
struct PathSums {
  alignas(64) double sum[3][kLightsTogether];
  alignas(64) double luminance[kLightsTogether], luminance_sq[kLightsTogether];
};

/// Adds the contribution of each of the first `lights` lights along one path; omits values that are not finite and
/// returns their number. `luminance_weights`: for the color space of `path`.
uint32_t add_path(const float (&path)[3][kLightsTogether], const Vec3& luminance_weights, uint32_t lights,
                  PathSums& sums);

}  // namespace velour

// Partly transparent surfaces (alpha).
#pragma once

#include <span>
#include <vector>

#include "capture/repeated_tile.h"
#include "render/footprint.h"

namespace velour {

/// Lets each ray through a surface with probability 1 - Material::alpha, which is unbiased for any number of surfaces.
/// One per thread.
class Cutouts {
 public:
  explicit Cutouts(const RepeatedTile& tile);

  /// Whether any material of the tile lets rays through; if not, pass() need not be called.
  bool any() const { return any_; }
  /// Continues those `rays` whose `hits`, found by TileRays::intersect, let them through, and replaces both by the ray
  /// that ends the path and its hit. rays[i] takes its random numbers from keys[i]; `cone` is the rays' footprint.
  void pass(std::span<Ray> rays, std::span<Hit> hits, std::span<const uint64_t> keys, const RayCone& cone,
            TileRays& tracer, RayLog* log);

  /// Maximum number of surfaces that a ray passes through; rays that pass more count as misses.
  static constexpr int kMostCrossings = 4096;

 private:
  bool goes_on(const Ray& ray, const Hit& hit, uint64_t key, int crossing, const RayCone& cone, Vec3& from) const;

  const RepeatedTile& tile_;
  bool any_ = false;
  std::vector<uint32_t> ids_;
  std::vector<Ray> next_;
  std::vector<Hit> next_hits_;
};

}  // namespace velour
